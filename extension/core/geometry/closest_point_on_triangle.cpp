#include "core/geometry/closest_point_on_triangle.hpp"

#include <array>
#include <glm/geometric.hpp>

#include "core/geometry/triangle_pack.hpp"

namespace tactus {

namespace {

struct OnSegment {
    Vec3 point;
    double share;  // of the way from the start to the end, beyond [0, 1] where an end is nearest
};

OnSegment closest_on_segment(const Vec3& point, const Vec3& start, const Vec3& end) {
    const Vec3 edge = end - start;
    const double squared_length = glm::dot(edge, edge);
    const double share = squared_length > 1e-300 ? glm::dot(point - start, edge) / squared_length : 0.0;
    return {share <= 0.0 ? start : share >= 1.0 ? end : start + edge * share, share};
}

double squared_distance(const Vec3& p, const Vec3& q) {
    const Vec3 offset = p - q;
    return glm::dot(offset, offset);
}

}  // namespace

// The same steps as in offset_from_triangles, for the same reasons.
TriangleClosestPoint closest_point_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                               const Vec3& c) {
    OnSegment best = closest_on_segment(point, a, b);
    Vec3 best_edge = b - a;
    double least = squared_distance(point, best.point);
    for (const auto& [start, end] : {std::array{b, c}, std::array{c, a}}) {
        const OnSegment other = closest_on_segment(point, start, end);
        const double squared = squared_distance(point, other.point);
        if (squared < least) {
            best = other;
            best_edge = end - start;
            least = squared;
        }
    }
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ap = point - a;
    const Vec3 normal = glm::cross(ab, ac);
    const double squared_normal = glm::dot(normal, normal);
    const double area_ab = glm::dot(normal, glm::cross(ab, ap));
    const double area_ca = glm::dot(normal, glm::cross(ap, ac));
    const double area_bc = squared_normal - area_ab - area_ca;
    if (area_ab >= 0.0 && area_ca >= 0.0 && area_bc >= 0.0 &&
        squared_normal > glm::dot(ab, ab) * glm::dot(ac, ac) * flat_area * flat_area) {
        const double height = glm::dot(normal, point - best.point) / squared_normal;
        return {point - normal * height, TriangleFeature::face, Vec3(0.0)};
    }
    if (best.share <= 0.0 || best.share >= 1.0) {
        return {best.point, TriangleFeature::corner, Vec3(0.0)};
    }
    return {best.point, TriangleFeature::edge, glm::normalize(best_edge)};
}

}  // namespace tactus
