// Whether a point lies inside a closed mesh: see TriangleTree::winding.
#pragma once

namespace tactus {

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
