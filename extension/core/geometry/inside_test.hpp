// Whether a point lies inside a closed mesh. See also TriangleTree::winding.
#pragma once

#include "core/geometry/triangle_mesh.hpp"

namespace tactus {

// True where the triangles bound a solid: along every edge as many run one way as the other, corners at the
// same place (within a millionth of the size, along seams) being the same corner. Several shells, shells
// within shells and shells that cross are closed, too. False for sheets, soups, meshes with holes and
// triangles that are not turned alike. O(n).
//
// Edges are summed as signed random numbers of 128 bits: a closed mesh always sums to zero, another one does
// with a chance of 2^-128 (not one that somebody forged on purpose: then insides are wrong, nothing else).
bool is_closed(const TriangleMesh& mesh);

// How often the surface winds around a point: 0 outside, 1 inside a solid whose triangles run
// counter-clockwise seen from outside, -1 where they run clockwise; another number where shells overlap.
struct Winding {
    int number = 0;
    // False where the work ran out, and where rounding leaves it open from every side: `number` is then a
    // guess. On the surface itself it is any of those around.
    bool known = false;

    bool inside() const { return number != 0; }
};

}  // namespace tactus
