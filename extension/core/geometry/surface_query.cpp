#include "core/geometry/surface_query.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/geometry/triangle_tree.hpp"

namespace tactus {

namespace {

// In the frame of the part.
SurfaceHit nearest_in(const TouchPart& part, const Vec3& point, double max_distance) {
    const TriangleTree* tree = part.tree();
    if (tree == nullptr) {
        const SolidDistance solid = distance_to_solid(part.solid(), point);
        return {solid.distance < max_distance, point - solid.distance * solid.normal, solid.normal,
                solid.distance};
    }
    const NearestTriangle nearest = tree->nearest(point, max_distance);
    if (!(nearest.distance < max_distance)) {
        return {};
    }
    const PackOffset offset =
        offset_from_triangles(tree->pack(nearest.pack), {splat(point.x), splat(point.y), splat(point.z)});
    int lane = 0;
    for (int i = 1; i < lane_count; ++i) {
        lane = offset.squared[i] < offset.squared[lane] ? i : lane;
    }
    const Vec3 away(offset.offset.x[lane], offset.offset.y[lane], offset.offset.z[lane]);
    const double distance = std::sqrt(offset.squared[lane]);
    return {true, point - away, distance > 0.0 ? away / distance : Vec3(0.0, 1.0, 0.0), distance};
}

}  // namespace

SurfaceHit nearest_surface(const TouchShape& shape, const Pose& body, const Vec3& point,
                           double max_distance) {
    SurfaceHit best;
    best.distance = max_distance;
    for (const TouchPart& part : shape.parts) {
        const Vec3 in_part = to_local(part.pose, to_local(body, point));
        if (glm::length(in_part - part.center) - part.radius >= best.distance) {
            continue;
        }
        const SurfaceHit found = nearest_in(part, in_part, best.distance);
        if (found.hit && found.distance < best.distance) {
            best = {true, to_parent(body, to_parent(part.pose, found.point)),
                    body.rotation * (part.pose.rotation * found.normal), found.distance};
        }
    }
    return best.hit ? best : SurfaceHit{};
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
