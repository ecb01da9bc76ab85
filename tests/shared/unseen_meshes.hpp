// Meshes of kinds that nothing was tuned on: what the rough ones say of others is held against these.
#pragma once

#include "shared/rough_meshes.hpp"

namespace tactus::shared {

// A ball with hollow needles all over, whose open ends make its inside rough.
TriangleMesh urchin(int needles, int sides);

// A tube that winds around a ring, knotted, with grooves along it.
TriangleMesh knot(int around, int along);

// A bolt with twenty turns of a thread, open at both ends.
TriangleMesh bolt(int around, int along);

// Loose triangles at random, a few of them large.
TriangleMesh scattered(int triangles);

// A sheet that runs through itself.
TriangleMesh crumpled(int cells);

// A surface without sides.
TriangleMesh klein_bottle(int around, int across);

// A flat ring around a pit of slivers that all end in one point, off the middle by `tilt`.
TriangleMesh pit(int slivers, double tilt);

// The inside of most of a ball, open above, within the outside of another one.
TriangleMesh socket(int levels, double radius);

// Thin plates, a hundredth to a tenth of the size apart.
TriangleMesh comb(int plates, int cells);

// Steps of 1e-4 of the size over hills: thousands of long edges side by side.
TriangleMesh stairs(int steps);

std::span<const RoughMesh> unseen_meshes();

}  // namespace tactus::shared
