// Meshes that tests and benches share. All lengths in metres.
#pragma once

#include "core/mesh/triangle_mesh.hpp"

namespace tactus::shared {

// A sphere around the origin: an icosahedron whose triangles are split in four `levels` times and pushed out
// to the radius. 20 * 4^levels triangles.
TriangleMesh icosphere(int levels, double radius);

// The same with a scan's noise: every corner up or down by up to that share of an edge.
TriangleMesh rough_sphere(int levels, double radius, double share);

// Twelve triangles around the origin.
TriangleMesh box(const Vec3& half_extents);
// The same, each side a grid of cells x cells squares.
TriangleMesh grid_box(const Vec3& half_extents, int cells);

// cells x cells squares of two triangles over [-size/2, size/2]^2 in x-z; smooth hills with fine ripples on
// top.
TriangleMesh terrain(int cells, double size, double height);

// Two walls that meet along the z axis at the origin, opening upwards with the given angle between them
// (radians).
TriangleMesh groove(double angle, double length);

// A tip at the origin that so many triangles share; their other corners lie on a circle of radius 1 that far
// below.
TriangleMesh cone(std::uint32_t sides, double height);

// The wall of a bore around the y axis, open at both ends: `count` facets of two triangles.
TriangleMesh bore(int count, double radius, double half_length);

// A funnel around the y axis, open at both ends: `count` facets of two triangles from a rim of radius 0.5 at
// y = 0.5 to a throat of 0.05 at -0.1, as many down to -0.5. With `unevenness` up to 1 some facets are twice
// as wide as they would be, and the corners go up and down by a two thousandth of that.
TriangleMesh funnel(int count, double unevenness);

// count triangles with corners in a ball of the given radius.
TriangleMesh soup(int count, double radius, unsigned seed);

// The same with every corner rounded to single precision, as meshes come from Godot.
TriangleMesh in_single_precision(TriangleMesh mesh);

}  // namespace tactus::shared
