#include "physics/solid_properties.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace tactus {

namespace {

constexpr double pi = std::numbers::pi;

Mat3 diagonal(double x, double y, double z) {
    return {{x, 0.0, 0.0}, {0.0, y, 0.0}, {0.0, 0.0, z}};
}

// Inertia of a point of mass 1 at r: |r|^2 1 - r r^T.
Mat3 point_inertia(const Vec3& r) {
    return Mat3(glm::dot(r, r)) - glm::outerProduct(r, r);
}

// Rounding noise around zero is not a volume: compare with the cube around the mesh.
constexpr double least_filling = 1e-9;  // share of the bounding cube (dimensionless)

std::optional<SolidProperties> of(const SphereShape& sphere) {
    const double r2 = sphere.radius * sphere.radius;
    const double volume = 4.0 / 3.0 * pi * r2 * sphere.radius;
    return SolidProperties{volume, Vec3(0.0), Mat3(0.4 * volume * r2)};
}

std::optional<SolidProperties> of(const BoxShape& box) {
    const Vec3 h = box.half_extents;
    const double volume = 8.0 * h.x * h.y * h.z;
    const double k = volume / 3.0;
    return SolidProperties{
        volume, Vec3(0.0),
        diagonal(k * (h.y * h.y + h.z * h.z), k * (h.x * h.x + h.z * h.z), k * (h.x * h.x + h.y * h.y))};
}

SolidProperties upright_cylinder(double radius, double half_height) {
    const double r2 = radius * radius;
    const double volume = 2.0 * pi * r2 * half_height;
    const double across = volume * (r2 / 4.0 + half_height * half_height / 3.0);
    return {volume, Vec3(0.0), diagonal(across, volume * r2 / 2.0, across)};
}

std::optional<SolidProperties> of(const CylinderShape& cylinder) {
    return upright_cylinder(cylinder.radius, cylinder.half_height);
}

// A cylinder and two half balls, whose centroids lie 3/8 r beyond the cylinder's ends.
std::optional<SolidProperties> of(const CapsuleShape& capsule) {
    const double r = capsule.radius;
    const double s = capsule.half_segment;
    SolidProperties solid = upright_cylinder(r, s);
    const double balls = 4.0 / 3.0 * pi * r * r * r;
    const double across = balls * (0.4 * r * r + s * s + 0.75 * r * s);
    solid.volume += balls;
    solid.inertia += diagonal(across, 0.4 * balls * r * r, across);
    return solid;
}

std::optional<SolidProperties> of(const PlaneShape&) {
    return std::nullopt;
}
std::optional<SolidProperties> of(const HeightFieldShape&) {
    return std::nullopt;
}
std::optional<SolidProperties> of(const ConvexHullShape& hull) {
    return solid_properties(*hull.hull);
}
std::optional<SolidProperties> of(const MeshShape& mesh) {
    return solid_properties(*mesh.mesh);
}

}  // namespace

std::optional<SolidProperties> solid_properties(const Shape& shape) {
    return std::visit([](const auto& any) { return of(any); }, shape);
}

// The sum over the tetrahedra between each triangle and a fixed point, taken inside the mesh for precision.
// With corners a, b, c seen from there, a tetrahedron has the signed volume V = a . (b x c) / 6, the centroid
// (a + b + c) / 4 and the second moment V / 20 (a a^T + b b^T + c c^T + s s^T), s = a + b + c.
std::optional<SolidProperties> solid_properties(const TriangleMesh& mesh) {
    if (mesh.vertices.empty())
        return std::nullopt;
    Vec3 low = mesh.vertices.front();
    Vec3 high = low;
    for (const Vec3& v : mesh.vertices) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    const Vec3 origin = 0.5 * (low + high);

    double volume = 0.0;
    Vec3 first(0.0);
    Mat3 second(0.0);
    Vec3 area(0.0);  // zero for a closed surface
    double total_area = 0.0;
    for (const auto& triangle : mesh.triangles) {
        const Vec3 a = mesh.vertices[triangle[0]] - origin;
        const Vec3 b = mesh.vertices[triangle[1]] - origin;
        const Vec3 c = mesh.vertices[triangle[2]] - origin;
        const Vec3 s = a + b + c;
        const double v = glm::dot(a, glm::cross(b, c)) / 6.0;
        volume += v;
        first += v / 4.0 * s;
        second += v / 20.0 *
                  (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c) +
                   glm::outerProduct(s, s));
        const Vec3 face = 0.5 * glm::cross(b - a, c - a);
        area += face;
        total_area += glm::length(face);
    }
    const double edge = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (!(volume > least_filling * edge * edge * edge))
        return std::nullopt;
    // The area vectors of a closed surface cancel; a rim that is left open leaves its own area behind.
    constexpr double open_share = 1e-3;
    if (glm::length(area) > open_share * total_area)
        return std::nullopt;

    const Vec3 centroid = first / volume;
    const Mat3 moment = second - volume * glm::outerProduct(centroid, centroid);
    const double trace = moment[0][0] + moment[1][1] + moment[2][2];
    return SolidProperties{volume, origin + centroid, Mat3(trace) - moment};
}

SolidProperties placed(const SolidProperties& solid, const Pose& pose) {
    const Mat3 rotation = glm::mat3_cast(pose.rotation);
    return {solid.volume, to_parent(pose, solid.centroid),
            rotation * solid.inertia * glm::transpose(rotation)};
}

Mat3 inertia_about(const SolidProperties& solid, const Vec3& point) {
    return solid.inertia + solid.volume * point_inertia(solid.centroid - point);
}

SolidProperties combined(const std::vector<SolidProperties>& parts) {
    SolidProperties whole;
    for (const SolidProperties& part : parts) {
        whole.volume += part.volume;
        whole.centroid += part.volume * part.centroid;
    }
    whole.centroid /= whole.volume;
    for (const SolidProperties& part : parts)
        whole.inertia += inertia_about(part, whole.centroid);
    return whole;
}

bool is_possible_inertia(const Vec3& moments) {
    constexpr double rounding = 0.01;
    const double largest = std::max({moments.x, moments.y, moments.z});
    return largest <= (1.0 + rounding) * (moments.x + moments.y + moments.z - largest);
}

Vec3 possible_inertia(const Vec3& moments) {
    const double half_trace = 0.5 * (moments.x + moments.y + moments.z);
    const Vec3 second = glm::max(Vec3(half_trace) - moments, Vec3(0.0));
    return Vec3(second.x + second.y + second.z) - second;
}

}  // namespace tactus
