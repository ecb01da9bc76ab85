// Which meshes bound a solid: only they have an inside (see winding.hpp).
#pragma once

#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

// True where the triangles bound a solid: along every edge as many run one way as the other, corners at the
// same place (within a millionth of the size, along seams) being the same corner. Several shells, shells
// within shells and shells that cross are closed, too. False for sheets, soups, meshes with holes and
// triangles that are not turned alike. O(n).
//
// Edges are summed as signed random numbers of 128 bits: a closed mesh always sums to zero, another one does
// with a chance of 2^-128 (not one that somebody forged on purpose: then insides are wrong, nothing else).
bool is_closed(const TriangleMesh& mesh);

}  // namespace tactus
