#include "core/geometry/closest_point_on_triangle.hpp"

#include <glm/geometric.hpp>

#include "core/geometry/triangle_pack.hpp"

namespace tactus {

namespace {

struct OnSegment {
    Vec3 point;
    double share;    // of the way from the start to the end, beyond [0, 1] where an end is nearest
    double squared;  // distance to it (unit: square meters)
};

OnSegment closest_on_segment(const Vec3& point, const Vec3& start, const Vec3& end) {
    const Vec3 edge = end - start;
    const double squared_length = glm::dot(edge, edge);
    const double share = squared_length > 1e-300 ? glm::dot(point - start, edge) / squared_length : 0.0;
    const Vec3 nearest = share <= 0.0 ? start : share >= 1.0 ? end : start + edge * share;
    const Vec3 offset = point - nearest;
    return {nearest, share, glm::dot(offset, offset)};
}

}  // namespace

// The same as in offset_from_triangles, for the same reasons; the height over a triangle that is no sliver
// does not depend on where in its plane it is measured from.
TriangleClosestPoint closest_point_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                               const Vec3& c) {
    constexpr double plain_area = 0.1;
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ap = point - a;
    const Vec3 normal = glm::cross(ab, ac);
    const double squared_normal = glm::dot(normal, normal);
    const double squared_sides = glm::dot(ab, ab) * glm::dot(ac, ac);
    const double area_ab = glm::dot(normal, glm::cross(ab, ap));
    const double area_ca = glm::dot(normal, glm::cross(ap, ac));
    const double area_bc = squared_normal - area_ab - area_ca;
    const bool inside = area_ab >= 0.0 && area_ca >= 0.0 && area_bc >= 0.0 &&
                        squared_normal > squared_sides * (flat_area * flat_area);
    if (inside && squared_normal > squared_sides * (plain_area * plain_area)) {
        return {point - normal * (glm::dot(normal, ap) / squared_normal), TriangleFeature::face};
    }
    const OnSegment edges[3] = {closest_on_segment(point, a, b), closest_on_segment(point, b, c),
                                closest_on_segment(point, c, a)};
    std::uint8_t nearest = edges[1].squared < edges[0].squared ? 1 : 0;
    nearest = edges[2].squared < edges[nearest].squared ? 2 : nearest;
    const OnSegment& best = edges[nearest];
    if (inside) {
        const double height = glm::dot(normal, point - best.point) / squared_normal;
        return {point - normal * height, TriangleFeature::face};
    }
    const bool is_corner = best.share <= 0.0 || best.share >= 1.0;
    return {best.point, is_corner ? TriangleFeature::corner : TriangleFeature::edge, nearest};
}

}  // namespace tactus
