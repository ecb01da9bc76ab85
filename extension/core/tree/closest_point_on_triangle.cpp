#include "core/tree/closest_point_on_triangle.hpp"

#include <glm/geometric.hpp>

#include "core/tree/triangle_pack.hpp"

namespace tactus {

namespace {

constexpr double plain_area = 0.1;  // as flat_area

// Of the triangle and of what it makes with the point above each side, as the normal sees them.
struct Areas {
    Vec3 normal;  // twice as long as the triangle's area
    double squared_normal;
    double squared_sides;
    bool inside;

    bool exceed(double area) const { return squared_normal > squared_sides * (area * area); }
};

Areas areas_of(const Vec3& ap, const Vec3& ab, const Vec3& ac) {
    const Vec3 normal = glm::cross(ab, ac);
    const double squared_normal = glm::dot(normal, normal);
    const double area_ab = glm::dot(normal, glm::cross(ab, ap));
    const double area_ca = glm::dot(normal, glm::cross(ap, ac));
    const double area_bc = squared_normal - area_ab - area_ca;
    return {normal, squared_normal, glm::dot(ab, ab) * glm::dot(ac, ac),
            area_ab >= 0.0 && area_ca >= 0.0 && area_bc >= 0.0};
}

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
    const Vec3 ap = point - a;
    const Areas areas = areas_of(ap, b - a, c - a);
    const bool inside = areas.inside && areas.exceed(flat_area);
    if (inside && areas.exceed(plain_area)) {
        return {point - areas.normal * (glm::dot(areas.normal, ap) / areas.squared_normal),
                TriangleFeature::face};
    }
    const OnSegment edges[3] = {closest_on_segment(point, a, b), closest_on_segment(point, b, c),
                                closest_on_segment(point, c, a)};
    std::uint8_t nearest = edges[1].squared < edges[0].squared ? 1 : 0;
    nearest = edges[2].squared < edges[nearest].squared ? 2 : nearest;
    const OnSegment& best = edges[nearest];
    if (inside) {
        const double height = glm::dot(areas.normal, point - best.point) / areas.squared_normal;
        return {point - areas.normal * height, TriangleFeature::face};
    }
    const bool is_corner = best.share <= 0.0 || best.share >= 1.0;
    return {best.point, is_corner ? TriangleFeature::corner : TriangleFeature::edge, nearest};
}

bool is_above_face(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Areas areas = areas_of(point - a, b - a, c - a);
    return areas.inside && areas.exceed(plain_area);
}

}  // namespace tactus
