// Normals at the corners of a mesh as if its facets were one round surface: for a force whose direction does
// not jump from facet to facet (force shading). The proxy itself stays on the facets.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

// One unit normal for each corner, in the frame of the mesh.
using CornerNormals = std::array<glm::vec3, 3>;

// One entry a triangle. Corners at the same place share the mean of their facets' normals, each weighted by
// its angle there; facets that meet at more than `crease` (radians) do not mix.
std::vector<CornerNormals> smooth_normals(const TriangleMesh& mesh, double crease);

// The interpolated normal at a point of a triangle with corners a, b, c; unit length, or `otherwise` where
// the corner normals cancel.
Vec3 interpolated_normal(const CornerNormals& normals, const Vec3& a, const Vec3& b, const Vec3& c,
                         const Vec3& point, const Vec3& otherwise);

}  // namespace tactus
