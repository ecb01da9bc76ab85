#include "world/drawn_shape.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>

#include "core/geometry/touch_shape.hpp"
#include "core/math/perpendicular.hpp"
#include "core/mesh/smooth_normals.hpp"

namespace tactus {

namespace {

constexpr std::uint32_t around = 48;  // facets around what is round
constexpr std::uint32_t quarter = 8;  // and along a quarter of a circle

constexpr double half_plane_side = 10.0;  // a plane without end is drawn so wide (unit: meters)

constexpr std::uint32_t tube_sides = 6;

// More than facets of what is round meet at, less than an edge.
constexpr double crease_of_round = 0.6;
constexpr double crease_of_tube = 1.2;

// Joins two rings of `sides` vertices each, whose numbers begin at a and b, by triangles.
void join_rings(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t sides) {
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t next = (i + 1) % sides;
        mesh.triangles.push_back({a + i, b + i, a + next});
        mesh.triangles.push_back({a + next, b + i, b + next});
    }
}

struct Ring {
    double radius = 0.0;
    double height = 0.0;
};

// A surface of revolution about y, from its lowest ring to its highest; both are points.
TriangleMesh revolved(const std::vector<Ring>& rings) {
    TriangleMesh mesh;
    for (const Ring& ring : rings) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / around;
            mesh.vertices.emplace_back(ring.radius * std::cos(angle), ring.height,
                                       ring.radius * std::sin(angle));
        }
    }
    for (std::uint32_t ring = 0; ring + 1 < rings.size(); ++ring) {
        join_rings(mesh, ring * around, (ring + 1) * around, around);
    }
    return mesh;
}

// A capsule whose two halves are so far from its middle; a sphere where that is 0.
TriangleMesh capsule(double radius, double half_segment) {
    std::vector<Ring> rings;
    for (std::uint32_t i = 0; i <= 2 * quarter; ++i) {
        const double angle = std::numbers::pi * (i / (2.0 * quarter) - 0.5);
        const double shift = i < quarter ? -half_segment : half_segment;
        if (i == quarter && half_segment > 0.0) {
            rings.push_back({radius, -half_segment});
        }
        rings.push_back({radius * std::cos(angle), radius * std::sin(angle) + shift});
    }
    return revolved(rings);
}

TriangleMesh box(const Vec3& half) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.vertices.emplace_back((i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                                   (i & 4) != 0 ? half.z : -half.z);
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

TriangleMesh square(const PlaneShape& plane) {
    const Vec3 u = half_plane_side * any_perpendicular(plane.normal);
    const Vec3 v = glm::cross(plane.normal, u);
    const Vec3 middle = plane.offset * plane.normal;
    return {{middle - u - v, middle + u - v, middle + u + v, middle - u + v}, {{0, 1, 2}, {0, 2, 3}}};
}

struct Draw {
    Drawing operator()(const SphereShape& shape) const {
        return {capsule(shape.radius, 0.0), crease_of_round};
    }
    Drawing operator()(const BoxShape& shape) const { return {box(shape.half_extents)}; }
    Drawing operator()(const CapsuleShape& shape) const {
        return {capsule(shape.radius, shape.half_segment), crease_of_round};
    }
    Drawing operator()(const CylinderShape& shape) const {
        return {revolved({{0.0, -shape.half_height},
                          {shape.radius, -shape.half_height},
                          {shape.radius, shape.half_height},
                          {0.0, shape.half_height}}),
                crease_of_round};
    }
    Drawing operator()(const PlaneShape& shape) const { return {square(shape)}; }
    Drawing operator()(const ConvexHullShape& shape) const { return {*shape.hull}; }
    Drawing operator()(const MeshShape& shape) const { return {*shape.mesh}; }
    Drawing operator()(const HeightFieldShape& shape) const { return {height_field_mesh(shape)}; }
};

Vec3 direction_at(const std::vector<Vec3>& points, std::size_t i, bool closed) {
    const std::size_t last = points.size() - 1;
    const Vec3& before = i > 0 ? points[i - 1] : points[closed ? last : 0];
    const Vec3& after = i < last ? points[i + 1] : points[closed ? 0 : last];
    const Vec3 way = after - before;
    const double length = glm::length(way);
    return length > 0.0 ? way / length : Vec3(1.0, 0.0, 0.0);
}

// Flat ones are found at once, also of millions of triangles.
std::vector<CornerNormals> shading(const Drawing& drawing) {
    if (drawing.crease > 0.0) {
        return smooth_normals(drawing.mesh, drawing.crease);
    }
    std::vector<CornerNormals> normals;
    for (const auto& [a, b, c] : drawing.mesh.triangles) {
        const Vec3& corner = drawing.mesh.vertices[a];
        const Vec3 cross = glm::cross(drawing.mesh.vertices[b] - corner, drawing.mesh.vertices[c] - corner);
        const double area = glm::length(cross);
        const glm::vec3 normal(area > 0.0 ? cross / area : cross);
        normals.push_back({normal, normal, normal});
    }
    return normals;
}

}  // namespace

DrawnCorners corners_of(const Drawing& drawing) {
    const std::vector<CornerNormals> normals = shading(drawing);
    DrawnCorners drawn;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        for (const std::size_t corner : {0u, 2u, 1u}) {
            drawn.places.emplace_back(drawing.mesh.vertices[drawing.mesh.triangles[i][corner]]);
            drawn.normals.push_back(normals[i][corner]);
        }
    }
    return drawn;
}

Drawing drawn_shape(const Shape& shape) {
    return std::visit(Draw{}, shape);
}

Drawing tube(const std::vector<Vec3>& points, double thickness, bool closed) {
    Drawing drawing{{}, crease_of_tube};
    TriangleMesh& mesh = drawing.mesh;
    if (points.size() < 2) {
        return drawing;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 along = direction_at(points, i, closed);
        const Vec3 u = any_perpendicular(along);
        const Vec3 v = glm::cross(along, u);
        for (std::uint32_t side = 0; side < tube_sides; ++side) {
            const double angle = 2.0 * std::numbers::pi * side / tube_sides;
            mesh.vertices.push_back(points[i] +
                                    0.5 * thickness * (std::cos(angle) * u + std::sin(angle) * v));
        }
    }
    const auto rings = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t ring = 0; ring < (closed ? rings : rings - 1); ++ring) {
        join_rings(mesh, (ring + 1) % rings * tube_sides, ring * tube_sides, tube_sides);
    }
    return drawing;
}

Drawing drawn_cube_edges(double half_side, double thickness) {
    const double h = half_side;
    const std::vector<Vec3> floor = {{-h, -h, -h}, {h, -h, -h}, {h, -h, h}, {-h, -h, h}};
    Drawing edges{{}, crease_of_tube};
    const auto add = [&](const Vec3& from, const Vec3& to) {
        const TriangleMesh edge = tube({from, to}, thickness, false).mesh;
        const auto first = static_cast<std::uint32_t>(edges.mesh.vertices.size());
        std::ranges::copy(edge.vertices, std::back_inserter(edges.mesh.vertices));
        for (const auto& [a, b, c] : edge.triangles) {
            edges.mesh.triangles.push_back({first + a, first + b, first + c});
        }
    };
    const Vec3 up(0.0, 2.0 * h, 0.0);
    for (std::size_t i = 0; i < floor.size(); ++i) {
        const Vec3& next = floor[(i + 1) % floor.size()];
        add(floor[i], next);
        add(floor[i] + up, next + up);
        add(floor[i], floor[i] + up);
    }
    return edges;
}

Drawing drawn_path(const HandPath& path, double thickness) {
    constexpr int steps = 600;  // 3 mm apart on the path of the thesis
    if (!problem_with(path).empty()) {
        return {};
    }
    const bool closed = std::holds_alternative<CircleWave>(path);
    const Nanoseconds duration = path_duration(path);
    std::vector<Vec3> points;
    for (int i = 0; i < steps; ++i) {
        points.push_back(sample_path(path, duration * i / (closed ? steps : steps - 1)).position);
    }
    return tube(points, thickness, closed);
}

}  // namespace tactus
