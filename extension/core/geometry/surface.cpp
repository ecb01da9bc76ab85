#include "core/geometry/surface.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "core/tree/triangle_pack.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

// The direction of the offset is as exact as the coordinates are over the distance. The triangle's own normal
// does not suffer from a small distance far from the origin, but from the triangle being a sliver.
Vec3 normal_at(const TriangleCorners& t, TriangleFeature kind, const Vec3& offset, double distance) {
    if (kind == TriangleFeature::face) {
        const Vec3 ab = t.b - t.a;
        const Vec3 ac = t.c - t.a;
        const Vec3 across = glm::cross(ab, ac);
        const double squared = glm::dot(across, across);
        if (squared > sliver_area * sliver_area * glm::dot(ab, ab) * glm::dot(ac, ac)) {
            return across * (std::copysign(1.0, glm::dot(across, offset)) / std::sqrt(squared));
        }
    }
    return distance > 0.0 ? offset / distance : Vec3(0.0, 1.0, 0.0);
}

}  // namespace

SurfacePoint surface_point(const TouchPart& part, std::uint32_t triangle, const Vec3& center) {
    if (!part.tree()) {
        const SolidDistance at = distance_to_solid(part.solid(), center);
        return {at.distance, center - at.normal * at.distance, at.normal};
    }
    const TriangleCorners t = part.tree()->corners(triangle);
    const TriangleClosestPoint closest = closest_point_on_triangle(center, t.a, t.b, t.c);
    const Vec3 offset = center - closest.point;
    const double distance = glm::length(offset);
    return {distance, closest.point, normal_at(t, closest.feature, offset, distance), closest.feature,
            closest.edge};
}

Hit sweep_surface(const TouchPart& part, const SphereWay& way, double limit, WorkBudget& work) {
    return part.tree() ? part.tree()->sweep(way, limit, work)
                       : sweep_to_solid(part.solid(), way, limit, work);
}

}  // namespace tactus
