// Which vertices of a mesh are one place. Files and engines split vertices along seams of texture or shading;
// touch knows only where they are.
#pragma once

#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

// By vertex: the first with the same coordinates, itself where there is none before. 0 and -0 are the same.
std::vector<std::uint32_t> same_places(std::span<const Vec3> vertices);

// One vertex for each place, in the order of the first ones. An index without a vertex stays one. Returns, by
// the vertex that there was, the one that it is now.
std::vector<std::uint32_t> merge_places(TriangleMesh& mesh);

}  // namespace tactus
