// The surface on which a field of samples has one value, as triangles: voxel volumes and signed distances are
// touched, collide and are drawn by what meshes have already.
//
// Between its samples the field is trilinear. Where a cell's piece of the surface meets the cell's edges, the
// triangles have their corners; on the cell's faces they join as the field does. What they leave out inside
// of a cell is about d^2 / 8r, with d the diagonal of a cell and r the radius at which the surface bends.
#pragma once

#include <string>

#include "core/mesh/sampled_field.hpp"
#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

struct IsoSurface {
    TriangleMesh mesh;
    std::string error;  // of check_field, or more triangles than anybody can touch
};

// Always closed: a solid that reaches the border of the samples ends there. The same field gives the same
// triangles, bit for bit.
IsoSurface iso_surface(const SampledField& field);

}  // namespace tactus
