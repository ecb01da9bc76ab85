// Thousands of bodies of one form, each with a shape of its own.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/haptics/touch_scene.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

struct ManyBodies {
    std::shared_ptr<const TouchShape> shape;
    std::vector<Vec3> places;  // in the world (unit: meters)
    TouchScene scene{places.size(), places.size()};
    int ticks = 0;

    ManyBodies(const Shape& form, std::vector<Vec3> at) : places(std::move(at)) {
        const PlacedShape placed{form, {}};
        shape = make_touch_shape({&placed, 1}).shape;
        for (const Vec3& place : places) {
            scene.add(*shape, pose_at(place), {}, 1);
        }
    }

    // One tick, in which each has gone to and fro by up to `by` (unit: meters); 0: all stand still.
    void tick(double by = 0.0) {
        scene.begin_tick();
        ++ticks;
        for (std::size_t i = 0; by > 0.0 && i < places.size(); ++i) {
            const double phase = 0.01 * ticks + static_cast<double>(i);
            scene.set_pose(static_cast<int>(i),
                           pose_at(places[i] + by * Vec3(std::sin(phase), std::cos(phase), 0.0)));
        }
    }

private:
    static Pose pose_at(const Vec3& place) { return {place, {1.0, 0.0, 0.0, 0.0}}; }
};

// Boxes of 0.15 m in rows, 0.05 m apart, their tops at 0.075 m.
inline ManyBodies boxes_apart(int count) {
    std::vector<Vec3> places;
    for (int i = 0; i < count; ++i) {
        places.emplace_back(0.2 * (i % 32), 0.0, -0.2 * (i / 32));
    }
    return {BoxShape{Vec3(0.075)}, places};
}

// Balls of a fifth of a sphere's radius, all of them within its reach where it is at the origin.
inline ManyBodies heap_of_balls(int count, double radius) {
    RandomValues random(5);
    std::vector<Vec3> places;
    for (int i = 0; i < count; ++i) {
        places.push_back(random.in_box(1.2 * radius));
    }
    return {SphereShape{0.2 * radius}, places};
}

// Through that heap and out of it again, on all sides.
inline Vec3 through_heap(double radius, double seconds) {
    return radius *
           Vec3(3.0 * std::cos(4.0 * seconds), 2.0 * std::sin(7.1 * seconds), 1.5 * std::sin(1.3 * seconds));
}

}  // namespace tactus::shared
