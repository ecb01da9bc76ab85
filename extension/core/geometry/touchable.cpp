// Faces first, then the edges and corners of triangles that cannot be touched by their faces: one that can
// be is left to a triangle that is there already, or to the first of those that share it.
#include "core/geometry/touchable.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <span>

#include "core/geometry/corner_cone.hpp"
#include "core/geometry/empty_ball.hpp"

namespace tactus {

namespace {

constexpr std::size_t part_size = 1024;  // triangles, or corners, for one thread at a time
// A corner of more triangles counts as one that can be touched: all pairs of its edges are looked at.
constexpr std::size_t max_at_corner = 24;
constexpr double least_radius = 1e-7;     // of the largest coordinate: below it rounding is not small
constexpr double worthwhile_share = 0.9;  // where more can be touched a tree of these alone is of little use

using Marks = std::vector<std::uint8_t>;  // by triangle

void mark(Marks& marks, std::uint32_t triangle) {
    std::atomic_ref(marks[triangle]).store(1, std::memory_order_relaxed);
}

bool is_face_touchable(const SharedMesh& shared, std::uint32_t triangle, EmptyBall& ball) {
    const auto& [i, k, m] = shared.mesh.triangles[triangle];
    const Vec3 a = shared.place(i), b = shared.place(k), c = shared.place(m);
    const Vec3 across = glm::cross(b - a, c - a);
    const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
    const double doubt = shared.rounding * longest / std::max(glm::length(across), 1e-300);
    const auto touches_towards = [&](const Vec3& direction) {
        return ball.may_touch({{a, b, c}, 3, {direction}, 1, doubt});
    };
    const Vec3 normal = unit(across);
    return !(doubt <= max_doubt) || touches_towards(normal) || touches_towards(-normal);
}

// From the edge into the triangle, perpendicular to the edge (unit: meters).
Vec3 height_over(const SharedMesh& shared, std::uint32_t triangle, const Vec3& from, const Vec3& along) {
    Vec3 highest(0.0);
    for (const std::uint32_t corner : shared.mesh.triangles[triangle]) {
        const Vec3 way = shared.place(corner) - from;
        const Vec3 height = way - along * glm::dot(along, way);
        highest = glm::dot(height, height) > glm::dot(highest, highest) ? height : highest;
    }
    return highest;
}

// Directions across the edge that do not lead into its triangles: an arc between the normals of both, where
// they meet at an angle. Of a flat edge the faces have said all.
bool is_edge_touchable(const SharedMesh& shared, std::uint32_t from, std::uint32_t to,
                       std::span<const std::uint32_t> triangles, EmptyBall& ball) {
    const Vec3 a = shared.place(from), b = shared.place(to);
    const Vec3 along = unit(b - a);
    const Vec3 height = height_over(shared, triangles[0], a, along);
    const Vec3 other = triangles.size() > 1 ? height_over(shared, triangles[1], a, along) : height;
    const double least = std::min(glm::length(height), glm::length(other));
    const double doubt = shared.rounding / std::max(std::min(least, glm::distance(a, b)), 1e-300);
    if (!(doubt <= max_doubt) || triangles.size() > 2) {
        return true;
    }
    const Vec3 inward = unit(height), other_inward = unit(other);
    const auto touches_between = [&](const Vec3& u, const Vec3& v) {
        return ball.may_touch({{a, b}, 2, {u, v}, 2, doubt});
    };
    Vec3 first = glm::cross(along, inward);
    Vec3 second = -first;  // where the surface ends there is but one triangle
    if (triangles.size() == 2) {
        const double bend = glm::dot(first, other_inward);
        second = glm::cross(along, other_inward);
        first = bend > 0.0 ? -first : first;
        second = glm::dot(second, inward) > 0.0 ? -second : second;
        if (std::abs(bend) <= std::max(parallel_sine, doubt)) {
            return glm::dot(inward, other_inward) > 0.0;  // folded onto itself
        }
    }
    const Vec3 middle = -unit(inward + other_inward);
    return glm::dot(first, second) > 0.0 ? touches_between(first, second)
                                         : touches_between(first, middle) || touches_between(middle, second);
}

// Calls visit(other end, triangles) for each edge from the vertex to one of a higher number.
template <class Visit>
void visit_edges(const SharedMesh& shared, std::uint32_t vertex, Visit&& visit) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;  // and triangle
    for (const std::uint32_t triangle : shared.triangles_at(vertex)) {
        for (const std::uint32_t other : shared.mesh.triangles[triangle]) {
            if (other > vertex) {
                ends.emplace_back(other, triangle);
            }
        }
    }
    std::ranges::sort(ends);
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i < ends.size();) {
        const std::uint32_t end = ends[i].first;
        triangles.clear();
        for (; i < ends.size() && ends[i].first == end; ++i) {
            triangles.push_back(ends[i].second);
        }
        visit(end, std::span<const std::uint32_t>(triangles));
    }
}

}  // namespace

std::vector<std::uint32_t> touchable_slots(const TriangleTree& tree, double radius,
                                           const ParallelRunner& run) {
    const SharedMesh shared(tree);
    const std::size_t count = shared.slots.size();
    Marks by_face(count, 0), by_edge(count, 0), by_corner(count, 0);
    const auto is_any = [](const Marks& marks, std::span<const std::uint32_t> triangles) {
        return std::ranges::any_of(triangles, [&](std::uint32_t t) { return marks[t] != 0; });
    };
    const auto in_parts = [&](std::size_t number, auto&& look) {
        run_in_parts(run, number, part_size, [&](std::size_t, std::size_t begin, std::size_t end) {
            EmptyBall ball(tree, radius);
            for (std::size_t i = begin; i < end; ++i) {
                look(static_cast<std::uint32_t>(i), ball);
            }
        });
    };
    in_parts(count, [&](std::uint32_t triangle, EmptyBall& ball) {
        by_face[triangle] = is_face_touchable(shared, triangle, ball);
    });
    in_parts(shared.mesh.vertices.size(), [&](std::uint32_t vertex, EmptyBall& ball) {
        visit_edges(shared, vertex, [&](std::uint32_t end, std::span<const std::uint32_t> triangles) {
            if (!is_any(by_face, triangles) && is_edge_touchable(shared, vertex, end, triangles, ball)) {
                mark(by_edge, triangles.front());
            }
        });
    });
    in_parts(shared.mesh.vertices.size(), [&](std::uint32_t vertex, EmptyBall& ball) {
        const std::span<const std::uint32_t> triangles = shared.triangles_at(vertex);
        if (!triangles.empty() && !is_any(by_face, triangles) && !is_any(by_edge, triangles) &&
            (triangles.size() > max_at_corner || CornerCone(shared, vertex).may_touch(ball))) {
            mark(by_corner, triangles.front());
        }
    });
    std::vector<std::uint32_t> slots;
    for (std::size_t t = 0; t < count; ++t) {
        if (by_face[t] || by_edge[t] || by_corner[t]) {
            slots.push_back(shared.slots[t]);
        }
    }
    return slots;
}

std::shared_ptr<const TouchableTriangles> touchable_triangles(const TriangleTree& tree, double radius,
                                                              const ParallelRunner& run) {
    if (!(radius > least_radius * tree.magnitude())) {
        return nullptr;
    }
    const std::vector<std::uint32_t> slots = touchable_slots(tree, radius, run);
    if (static_cast<double>(slots.size()) > worthwhile_share * static_cast<double>(tree.triangle_count())) {
        return nullptr;
    }
    TriangleMesh mesh;
    for (const std::uint32_t slot : slots) {
        add_loose(mesh, tree.corners(slot));
    }
    TouchableTriangles touchable{radius, &tree, TriangleTree::build(mesh, run)};
    touchable.tree.name_triangles(slots);
    return std::make_shared<const TouchableTriangles>(std::move(touchable));
}

}  // namespace tactus
