// What the surfaces of a mesh feel like where they are not as their body does, and what of the mesh has to be
// read for that.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/shape.hpp"
#include "core/haptics/touch_material.hpp"

namespace tactus {

using SurfaceFeels = std::vector<std::optional<SurfaceFeel>>;  // none, or beyond: as the body

// Which surface each triangle belongs to, and where its corners are on images.
struct SurfaceParts {
    bool surfaces = false;
    bool uv = false;
    bool operator==(const SurfaceParts&) const = default;
};

// What is asked for: a mesh of one material without texture coordinates needs neither. `by_uv`: the body's
// own material is laid so.
SurfaceParts parts_for(const SurfaceFeels& feels, bool by_uv);
// What is there.
SurfaceParts parts_of(const SurfaceMap& map);

// Why not all of these are felt on a mesh of so many surfaces, and what to do; empty where they are. Of a
// mesh without a map nothing was asked for.
std::string problem_of(const SurfaceFeels& feels, std::size_t surface_count, const SurfaceMap* map);

// One surface of a mesh as it is drawn: clockwise triangles of so many corners; without indices, each corner
// in turn. A corner without coordinates has those of one point.
struct DrawnSurface {
    std::size_t number = 0;  // in its mesh
    std::size_t corner_count = 0;
    std::span<const std::int32_t> indices;
    std::span<const std::array<float, 2>> uv;
};
// Counter-clockwise triangles, in their order.
void add(SurfaceMap& map, const DrawnSurface& surface, const SurfaceParts& parts);

}  // namespace tactus
