// Whether a mesh can be touched at all, said before anything is built from it.
#pragma once

#include <string>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

// Empty when the mesh is sound; otherwise what is wrong and what to do about it. A mesh is refused when it
// has no triangles, a corner index out of range, a coordinate that is not a finite number or beyond 1e9 m, no
// area at all, or a size below 1e-9 m. Single triangles without area are accepted: they are touched along
// their edges.
std::string check_mesh(const TriangleMesh& mesh);

}  // namespace tactus
