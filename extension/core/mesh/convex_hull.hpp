// The smallest convex surface around a set of points.
#pragma once

#include <span>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

// Closed, its triangles counter-clockwise from outside, its vertices a subset of the points. Points within a
// hundred-millionth of the set's size of a face are taken to lie in it. Empty where the points have no volume
// (fewer than four, or all in one plane). The same points give the same hull, bit for bit.
TriangleMesh convex_hull(std::span<const Vec3> points);

}  // namespace tactus
