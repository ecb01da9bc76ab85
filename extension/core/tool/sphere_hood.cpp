#include "core/tool/sphere_hood.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/tree/triangle_tree.hpp"

namespace tactus {

double SphereHood::others(const Vec3& center) const {
    return clear_ - glm::distance(center, gathered_at_);
}

double SphereHood::nearest(const Vec3& center) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const HoodPlane& plane : planes()) {
        nearest = std::min(nearest, plane.at(center));
    }
    return nearest;
}

double SphereHood::least(const Vec3& center) const {
    return std::min(others(center), nearest(center));
}

// Where there is no room the farthest goes, and counts as one of the others.
void SphereHood::keep(const HoodPlane& plane, double distance, double& limit) {
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    if (count_ == capacity) {
        clear_ = std::min(clear_, distances_[at(capacity - 1)]);
        limit = std::min(limit, clear_);
        if (distance >= distances_[at(capacity - 1)]) {
            return;
        }
        --count_;
    }
    int place = count_++;
    for (; place > 0 && distance < distances_[at(place - 1)]; --place) {
        planes_[at(place)] = planes_[at(place - 1)];
        distances_[at(place)] = distances_[at(place - 1)];
    }
    planes_[at(place)] = plane;
    distances_[at(place)] = distance;
}

// With the work gone a part is as far away as its ball.
void SphereHood::gather(const TouchScene& scene, const PartBalls& parts, const Vec3& center, double limit,
                        double keep_within, double same, WorkBudget& work) {
    count_ = 0;
    clear_ = limit;
    worn_ = 0.0;
    gathered_at_ = center;
    looked_at_ = Vec3(std::numeric_limits<double>::infinity());
    parts.visit_within(center, limit, work, [&](std::uint32_t index) {
        const ScenePart& placed = scene.parts()[index];
        const Vec3 local = to_local(placed.pose, center);
        const double to_ball = glm::distance(local, placed.part->center) - placed.part->radius;
        if (to_ball >= limit || work.is_gone()) {
            clear_ = std::min(clear_, std::max(to_ball, 0.0));
            return;
        }
        HoodPlane plane;
        plane.part = index;
        const TriangleTree* const tree = placed.part->tree();
        if (tree == nullptr) {
            work.spend(cost::solid_look);
            const double distance = surface_point(*placed.part, Hit::no_triangle, local).distance;
            if (distance < limit) {
                keep(plane, distance, limit);
            }
            return;
        }
        const double unseen = tree->visit_near(local, limit, work, [&](std::uint32_t pack) {
            work.spend(cost::pack_look);
            const PackOffset offset = tree->offset_from_pack(pack, splat(local));
            for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
                const bool repeats = lane > 0 && tree->triangle_at(pack * lane_count + lane) ==
                                                     tree->triangle_at(pack * lane_count + lane - 1);
                const double distance = std::sqrt(offset.squared[lane]);
                if (!repeats && distance < limit) {
                    plane.triangle = pack * lane_count + lane;
                    keep(plane, distance, limit);
                }
            }
        });
        clear_ = std::min(clear_, unseen);
    });
    // What is farther is one of the others.
    while (count_ > 0 && distances_[static_cast<std::size_t>(count_ - 1)] > keep_within) {
        clear_ = std::min(clear_, distances_[static_cast<std::size_t>(--count_)]);
    }
    for (HoodPlane& plane : std::span(planes_).first(static_cast<std::size_t>(count_))) {
        plane.offset = -std::numeric_limits<double>::infinity();
    }
    look(scene, center, std::numeric_limits<double>::infinity(), same, work);
}

void SphereHood::look(const TouchScene& scene, const Vec3& center, double within, double same,
                      WorkBudget& work) {
    looked_at_ = center;
    looked_within_ = within;
    std::array<int, capacity> near;
    int near_count = 0;
    for (int i = 0; i < count_; ++i) {
        HoodPlane& plane = planes_[static_cast<std::size_t>(i)];
        if (plane.at(center) >= within) {
            continue;
        }
        near[static_cast<std::size_t>(near_count++)] = i;
        const ScenePart& placed = scene.parts()[plane.part];
        const SurfacePoint seen = surface_point(*placed.part, plane.triangle, to_local(placed.pose, center));
        work.spend(cost::closest_point);
        plane.normal = direction_to_parent(placed.pose, seen.normal);
        plane.offset = seen.distance - glm::dot(plane.normal, center);
        plane.point = to_parent(placed.pose, seen.point);
        plane.is_face = seen.kind == TriangleFeature::face;
        distances_[static_cast<std::size_t>(i)] = seen.distance;
    }
    const std::span<const int> looked(near.data(), static_cast<std::size_t>(near_count));
    for (const int i : looked) {
        planes_[static_cast<std::size_t>(i)].covered = std::ranges::any_of(
            looked, [&](int other) { return other != i && is_covered_by(scene, i, other, same, work); });
    }
}

// The point of an edge or corner lies on the other feature, which is nearer, or as near and comes first.
bool SphereHood::is_covered_by(const TouchScene& scene, int index, int other_index, double same,
                               WorkBudget& work) const {
    const HoodPlane& plane = planes_[static_cast<std::size_t>(index)];
    const HoodPlane& other = planes_[static_cast<std::size_t>(other_index)];
    const double farther =
        distances_[static_cast<std::size_t>(index)] - distances_[static_cast<std::size_t>(other_index)];
    if (plane.is_face || other.triangle == Hit::no_triangle || farther < -same ||
        (farther <= same && other_index > index)) {
        return false;
    }
    // All of the other one lies below its tangent, and on it where it is a face.
    const double above = glm::dot(other.normal, plane.point - other.point);
    if (above > same || (other.is_face && above < -same)) {
        return false;
    }
    if (glm::distance(plane.point, other.point) <= same) {
        return true;
    }
    const ScenePart& placed = scene.parts()[other.part];
    work.spend(cost::closest_point);
    return surface_point(*placed.part, other.triangle, to_local(placed.pose, plane.point)).distance <= same;
}

}  // namespace tactus
