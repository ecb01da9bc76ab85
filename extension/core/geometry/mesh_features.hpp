// Which triangles of a mesh share an edge or corner, and which of them owns it.
#pragma once

#include <vector>

#include "core/geometry/pack_labels.hpp"
#include "core/geometry/parallel.hpp"
#include "core/geometry/triangle_mesh.hpp"

namespace tactus {

struct TriangleFeatures {
    EdgeLink neighbour[3];  // by edge, as triangles of the mesh
    OwnedFeatures owned;
};

// By triangle. An edge is decided where exactly two triangles meet, whatever their winding, and neither is a
// needle; a corner where its triangles are one closed fan of such edges. The lowest triangle owns both.
std::vector<TriangleFeatures> find_features(const TriangleMesh& mesh,
                                            const ParallelRunner& run = run_serially);

}  // namespace tactus
