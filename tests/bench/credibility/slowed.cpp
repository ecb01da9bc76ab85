// Bodies far from every hand, of which more are awake than take every step.
#include <algorithm>
#include <vector>

#include "credibility/cases.hpp"

namespace tactus::bench {

namespace {

PhysicsSettings crowded() {
    PhysicsSettings settings;
    settings.full_rate_bodies = 32;
    return settings;
}

Vec3 place_of(int i, double apart, double height) {
    return {apart * (i % 20), height, apart * (i / 20)};
}

struct Fallen {
    int through = 0;
    int slowed = 0;  // at the most
};

// Bodies that fall half a meter on a floor of 20 mm.
Fallen dropped(const std::vector<PlacedShape>& shape, double size, int count) {
    PhysicsWorld world(crowded());
    BodyDescription floor = shared::box({10.0, 0.02, 10.0}, {1.0, -0.01, 1.0}, 1.0);
    floor.motion = Motion::Static;
    enter(world, floor);
    std::vector<BodyId> bodies;
    for (int i = 0; i < count; ++i) {
        BodyDescription body = shared::box(Vec3(1.0), place_of(i, 0.12, 0.5 + size), 0.05);
        body.shapes = shape;
        body.can_sleep = false;
        bodies.push_back(enter(world, body));
    }
    world.settle_broad_phase();
    Fallen result;
    run_until(world, 1.5, [&](double) {
        result.slowed = std::max(result.slowed, static_cast<int>(world.slowed_count()));
        return false;
    });
    for (const BodyId id : bodies)
        result.through += world.pose(id).position.y < -0.01 ? 1 : 0;
    return result;
}

// Of those that are slowed, the largest deviation of what `measure` gives from that of the same body alone.
template <class Begin, class Measure>
double against_alone(Begin&& begin, double seconds, Measure&& measure) {
    const auto run = [&](int count) {
        PhysicsWorld world(crowded());
        enter(world, shared::ground(0.4));
        std::vector<BodyId> bodies;
        std::vector<bool> slowed(static_cast<std::size_t>(count), false);
        for (int i = 0; i < count; ++i)
            bodies.push_back(begin(world, i));
        world.settle_broad_phase();
        std::vector<double> best(bodies.size(), 0.0);
        run_until(world, seconds, [&](double t) {
            for (std::size_t i = 0; i < bodies.size(); ++i)
                best[i] = measure(world, bodies[i], t, best[i]);
            return false;
        });
        return best;
    };
    const double alone = run(1)[0];
    double worst = 0.0;
    for (const double one : run(300))
        worst = std::max(worst, deviation(one, alone));
    return worst;
}

double bounce() {
    return against_alone(
        [](PhysicsWorld& world, int i) {
            BodyDescription body = shared::ball(0.02, place_of(i, 0.12, 0.52), 0.05);
            body.material.restitution = 1.0;
            return enter(world, body);
        },
        // The first bounce ends after 3 times the fall.
        0.9,
        [](PhysicsWorld& world, BodyId id, double t, double best) {
            return t > 0.36 ? std::max(best, world.pose(id).position.y - 0.02) : best;
        });
}

double slide_way() {
    return against_alone(
        [](PhysicsWorld& world, int i) {
            BodyDescription body = shared::box(Vec3(0.04), place_of(i, 0.12, 0.02), 0.05, 0.4);
            body.linear_velocity = {1.0, 0.0, 0.0};
            return enter(world, body);
        },
        0.6,
        [start = std::vector<double>(8192, 1e9)](PhysicsWorld& world, BodyId id, double, double) mutable {
            double& from = start[id.index()];
            const double x = world.pose(id).position.x;
            from = std::min(from, x);
            return x - from;
        });
}

}  // namespace

void measure_slowed(Results& results) {
    int through = 0;
    int slowed = 0;
    const auto add = [&](const Fallen& fallen) {
        through += fallen.through;
        slowed += fallen.slowed;
    };
    add(dropped(shared::one(SphereShape{0.01}), 0.01, 300));
    add(dropped(shared::one(SphereShape{0.04}), 0.04, 300));
    add(dropped(shared::one(BoxShape{Vec3(0.02)}), 0.02, 300));
    add(dropped(shared::one(BoxShape{Vec3(0.02)}), 0.02, 100));
    results.add("slowed.fallen_through", through);
    results.add("slowed.bodies", slowed);
    results.add("slowed.bounce", bounce());
    results.add("slowed.way", slide_way());
}

}  // namespace tactus::bench
