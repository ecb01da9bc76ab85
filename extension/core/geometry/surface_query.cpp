#include "core/geometry/surface_query.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

// In the frame of the part.
SurfaceHit nearest_in(const TouchPart& part, const Vec3& point, double max_distance, WorkBudget& work) {
    if (!part.tree()) {
        work.spend(cost::solid_look);
        const SolidDistance at = distance_to_solid(part.solid(), point);
        return {at.distance < max_distance, true, point - at.distance * at.normal, at.normal, at.distance};
    }
    const NearestTriangle nearest = part.tree()->nearest(point, max_distance, work);
    if (!(nearest.distance < max_distance)) {
        return {.complete = nearest.complete};
    }
    const PackOffset offset = part.tree()->offset_from_pack(nearest.pack, splat(point));
    const int best = lane_of_smallest(offset.squared);
    const Vec3 away = lane(offset.offset, best);
    const double distance = std::sqrt(offset.squared[best]);
    return {true, nearest.complete, point - away, distance > 0.0 ? away / distance : Vec3(0.0, 1.0, 0.0),
            distance};
}

}  // namespace

SurfaceHit nearest_surface(const TouchShape& shape, const Pose& body, const Vec3& point, double max_distance,
                           WorkBudget& work) {
    SurfaceHit best{.distance = max_distance};
    const Vec3 in_body = to_local(body, point);
    for (const TouchPart& part : shape.parts) {
        if (work.is_gone()) {
            best.complete = false;
            break;
        }
        work.spend(cost::part_look);
        const Vec3 in_part = to_local(part.pose, in_body);
        if (glm::length(in_part - part.center) - part.radius >= best.distance) {
            continue;
        }
        const SurfaceHit found = nearest_in(part, in_part, best.distance, work);
        const bool complete = best.complete && found.complete;
        if (found.hit) {
            best = {true, complete, to_parent(body, to_parent(part.pose, found.point)),
                    direction_to_parent(body, direction_to_parent(part.pose, found.normal)), found.distance};
        }
        best.complete = complete;
    }
    return best;
}

SurfaceHit nearest_surface(const TouchShape& shape, const Pose& body, const Vec3& point,
                           double max_distance) {
    WorkBudget unlimited(std::numeric_limits<std::int64_t>::max());
    return nearest_surface(shape, body, point, max_distance, unlimited);
}

// The ray's point nearest to the middle of each part's ball is farther from it than the ball reaches.
bool may_meet_ray(const TouchShape& shape, const Pose& body, const Vec3& start, const Vec3& direction,
                  double length) {
    return std::ranges::any_of(shape.parts, [&](const TouchPart& part) {
        const Vec3 center = to_parent(body, to_parent(part.pose, part.center));
        const double along = std::clamp(glm::dot(center - start, direction), 0.0, length);
        return glm::length(center - (start + along * direction)) <= part.radius;
    });
}

}  // namespace tactus
