// The triangles of a mesh in the order of the cells of a grid that they are in: what lies together stands
// together, and the upper part of a tree is there at once.
#pragma once

#include <memory>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "core/tree/parallel.hpp"
#include "core/tree/tree_split.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

struct SortedTriangles {
    std::unique_ptr<Primitive[]> primitives;
    std::vector<Range> cells;  // a binary tree: see TreeSplitter. Its first node stands at 1
};

// Places are taken from `origin`, in single precision. The result does not depend on the runner.
SortedTriangles sort_into_cells(const TriangleMesh& mesh, const CornerExtent& extent, const Vec3& origin,
                                const ParallelRunner& run);

}  // namespace tactus
