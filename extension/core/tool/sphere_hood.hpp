// What is near one sphere of a tool: the nearest features of the scene as tangent planes, and how far all the
// rest is.
//
// Distance to a convex feature lies above its tangents and changes by no more than the sphere moves. So what
// is found once bounds the distance wherever the sphere goes, and most spheres need no look for many ticks.
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "core/geometry/surface.hpp"
#include "core/haptics/touch_scene.hpp"
#include "core/tool/part_balls.hpp"

namespace tactus {

// All in the world.
struct HoodPlane {
    Vec3 normal{0.0, 1.0, 0.0};  // unit, from the feature to the sphere
    double offset = 0.0;     // the feature is no nearer to a point x than normal . x + offset (unit: meters)
    Vec3 point{0.0};         // of the feature, nearest to the sphere
    std::uint32_t part = 0;  // of the scene
    std::uint32_t triangle = Hit::no_triangle;
    bool is_face = true;
    // An edge or corner that lies on another feature, which is nearer: the surface there is flat or hollow as
    // the sphere sees it, and the other one stands for both.
    bool covered = false;

    double at(const Vec3& center) const {
        return normal.x * center.x + normal.y * center.y + normal.z * center.z + offset;
    }
};

class SphereHood {
public:
    static constexpr int capacity = 8;

    void forget() {
        clear_ = -std::numeric_limits<double>::infinity();
        count_ = 0;
    }
    // Surfaces may have come nearer by as much (unit: meters).
    void approach(double by) {
        clear_ -= by;
        worn_ += by;
        looked_at_ = Vec3(std::numeric_limits<double>::infinity());
        for (int i = 0; i < count_; ++i) {
            planes_[static_cast<std::size_t>(i)].offset -= by;
        }
    }
    std::span<const HoodPlane> planes() const { return {planes_.data(), static_cast<std::size_t>(count_)}; }

    // No feature but those of the planes is nearer to the centre than this (unit: meters).
    double others(const Vec3& center) const;
    // No feature of the planes is nearer to it (unit: meters).
    double nearest(const Vec3& center) const;
    // No feature is nearer to it (unit: meters).
    double least(const Vec3& center) const;

    // Looks for features nearer than `limit` among the parts, and remembers those nearer than `keep_within`
    // (unit: meters). Points within `same` of each other are one (unit: meters).
    void gather(const TouchScene& scene, const PartBalls& parts, const Vec3& center, double limit,
                double keep_within, double same, WorkBudget& work);
    // The same features, those nearer than `within` exactly as they are seen from `center`.
    void look(const TouchScene& scene, const Vec3& center, double within, double same, WorkBudget& work);
    bool is_full() const { return count_ == capacity; }
    // What has come nearer since it was gathered makes it see less than there is, by more than this (unit:
    // meters).
    bool is_worn(double by) const { return worn_ > by; }
    bool is_gathered_at(const Vec3& center) const { return gathered_at_ == center; }
    // Whether it was looked at no farther away than this (unit: meters).
    bool is_seen_from(const Vec3& center, double within, double away) const {
        const Vec3 apart = center - looked_at_;
        return looked_within_ >= within && glm::dot(apart, apart) <= away * away;
    }

private:
    void keep(const HoodPlane& plane, double distance, double& limit);
    bool is_covered_by(const TouchScene& scene, int index, int other_index, double same,
                       WorkBudget& work) const;

    std::array<HoodPlane, capacity> planes_;  // nearest first when they were gathered
    std::array<double, capacity> distances_{};
    int count_ = 0;
    double clear_ = -std::numeric_limits<double>::infinity();
    double worn_ = 0.0;
    Vec3 gathered_at_{0.0};
    Vec3 looked_at_{std::numeric_limits<double>::infinity()};
    double looked_within_ = 0.0;  // (unit: meters)
};

}  // namespace tactus
