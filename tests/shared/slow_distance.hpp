// Distances the slow way, in extended precision: what the fast kernels are held against.
//
// Every candidate is a convex combination of a triangle's corners, so no rounding can make the answer smaller
// than the true distance by more than the rounding of one subtraction, however thin the triangle is.
#pragma once

#include <array>
#include <glm/geometric.hpp>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus::shared {

using SlowVec3 = glm::vec<3, long double, glm::defaultp>;

struct SlowClosest {
    SlowVec3 point{0.0L};
    long double distance = 0.0L;
    int supports = 0;     // corners with weight: 1 corner, 2 edge, 3 face
    SlowVec3 edge{0.0L};  // unit, along the edge where supports is 2
};

using Corners = std::array<Vec3, 3>;

inline Corners corners_of(const TriangleMesh& mesh, std::size_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

SlowClosest slow_closest(const SlowVec3& point, const Corners& triangle);

inline long double slow_distance(const Vec3& point, const Corners& triangle) {
    return slow_closest(SlowVec3(point), triangle).distance;
}

// Nearest triangle of the whole mesh, one after the other.
long double slow_distance(const Vec3& point, const TriangleMesh& mesh);

// The first t in [0, 1] at which start + t * motion is within `distance` of the triangle, by searching for
// the minimum of the (convex) distance and bisecting before it; 2 where there is none. When start is within
// already: 0 when the way leads closer, 2 when not.
long double slow_sweep(const Vec3& start, const Vec3& motion, long double distance, const Corners& triangle);

// The first of all triangles of a mesh.
long double slow_sweep(const Vec3& start, const Vec3& motion, long double distance, const TriangleMesh& mesh);

}  // namespace tactus::shared
