// What of a mesh a sphere can touch at all. Over surfaces that are finer than the sphere it is little: of a
// scan's noise the peaks, of a narrow bore the rim. A tree of these alone answers for the whole mesh.
//
// A sphere touches a triangle from outside where a ball of its radius meets it in a point p and no point of
// the mesh lies inside the ball.
//
//   Shrinking. If a ball of radius d touches at p, so does every smaller one inside it that touches at p:
//   what cannot be touched with a radius R cannot with any larger one.
//
//   Nearest. If the nearest point of the mesh is d >= R away from a centre, the ball of radius d around it is
//   empty and touches the triangle there, so that this triangle can be touched with R, too. From wherever a
//   sphere of radius R fits, the nearest triangle is therefore one of those that R can touch: what keeps
//   clear of these, and is nowhere nearer than R to the others, is clear of all.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/tree/parallel.hpp"

namespace tactus {

class TriangleTree;

struct TouchableTriangles {
    double radius = 0.0;  // that spheres have at least (unit: meters)
    const TriangleTree* whole = nullptr;
    // Of these triangles alone. Its triangle_at() gives slots of the whole mesh's tree.
    std::shared_ptr<const TriangleTree> tree;
};

// Share of a sphere's radius with which it is looked at what it can touch: it may be let into a surface by
// the rest (see Surroundings::is_sure).
constexpr double touchable_share = 0.95;

// Slots of the triangles that some sphere of at least that radius can touch, and of some that none can: an
// edge or corner that several share is left to one of them. In rising order, the same whatever the runner.
// Any thread but the haptic one: it takes some microseconds a triangle.
std::vector<std::uint32_t> touchable_slots(const TriangleTree& tree, double radius,
                                           const ParallelRunner& run = run_serially);

// Asked again and again, on any of the runner's threads: what is not wanted any more is given up.
using StillWanted = std::function<bool()>;
inline bool is_always_wanted() {
    return true;
}

// Null where nearly all can be touched, where it would take too long to find out (more than some ten seconds
// of two threads), where rounding is not small beside the radius, and where it is given up.
std::shared_ptr<const TouchableTriangles> touchable_triangles(
    const TriangleTree& tree, double radius, const ParallelRunner& run = run_serially,
    const StillWanted& is_wanted = is_always_wanted);

}  // namespace tactus
