// Which triangles of a mesh meet where. Files and engines split vertices along seams of texture or shading:
// what counts is the place.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/geometry/pack_labels.hpp"
#include "core/geometry/parallel.hpp"
#include "core/geometry/triangle_mesh.hpp"

namespace tactus {

using TriangleCorners = std::array<std::uint32_t, 3>;

struct CornersByPlace {
    // Those of the mesh, a vertex that stands for all at its place in the place of each.
    std::vector<TriangleCorners> triangles;
    // The corners at vertex v are corner[first[v]] … corner[first[v + 1] - 1], the last triangle first; none
    // where another vertex stands for it.
    std::vector<std::uint32_t> first;
    std::vector<EdgeLink> corner;  // a triangle and the edge that leaves this corner

    std::span<const EdgeLink> at(std::size_t v) const {
        return std::span(corner).subspan(first[v], first[v + 1] - first[v]);
    }
};

CornersByPlace corners_by_place(const TriangleMesh& mesh, const ParallelRunner& run = run_serially);

}  // namespace tactus
