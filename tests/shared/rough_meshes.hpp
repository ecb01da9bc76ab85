// Meshes as they come out of scanners, sculpting and CAD programs, made from seeds: nothing about them is
// even. Every one fits a cube of edge 1 around the origin (unit: meters), so that a radius of 0.05 is 5 % of
// its size.
#pragma once

#include <span>
#include <string>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus::shared {

// The triangles of another mesh as well.
void append(TriangleMesh& mesh, const TriangleMesh& more);

// Moved and scaled into the cube of edge 1 around the origin.
TriangleMesh fitted(TriangleMesh mesh);

// A closed shape sampled unevenly, with noise along and across the surface, holes of all sizes, and patches
// that were scanned twice and lie over one another. About 20 * 4^levels triangles.
TriangleMesh scanned(int levels);

// Balls that melt into one another, cut out of a grid of tetrahedra (which leaves slivers), split in four
// `levels` times and put back onto the surface.
TriangleMesh blobs(int cells, int levels);

// Branches that fork six times, the same way.
TriangleMesh branches(int cells, int levels);

// A sphere with hills, ridges and pores down to the size of its triangles.
TriangleMesh displaced(int levels);

// Two displaced spheres, one a fiftieth of a percent of the size within the other: a hollow thin wall.
TriangleMesh shell(int levels);

// A box with rounded edges: two triangles for each face and `segments` slivers around each edge.
TriangleMesh rounded_box(int segments);

// A toothed wheel with a bore: filleted teeth, caps that are stitched from bore to rim with slivers.
TriangleMesh gear(int points);

// A bumpy ball whose triangles grow from 1e-5 at one pole to 1 at the other.
TriangleMesh graded(int sectors, int rings);

// A ball with heaps of loose tiny triangles on its surface.
TriangleMesh clustered(int heaps, int triangles_per_heap);

// A ball within a ball: room for a proxy of 0.2 in the middle, 1.5 times as wide as itself.
TriangleMesh cavity(int levels);

struct RoughMesh {
    const char* name;
    TriangleMesh (*make)();
};

// All of the bench, from 1 thousand to 2 million triangles.
std::span<const RoughMesh> rough_meshes();

}  // namespace tactus::shared
