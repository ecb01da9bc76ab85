// Triangles out of the surfaces of a drawn mesh, as an engine keeps them: packed places in single precision,
// clockwise front faces, corners split along seams.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "world/triangle_source.hpp"

namespace tactus {

using PackedPlace = std::array<float, 3>;

// Puts the surfaces of a mesh together. Drawn front faces are clockwise, ours counter-clockwise. Corners at
// the same place become one vertex, so that neighbours know each other.
class MeshCollector {
public:
    // Three corners a triangle; without indices, each corner in turn.
    void add(std::span<const PackedPlace> corners, std::span<const std::int32_t> indices);
    TriangleSource::Read take();

private:
    TriangleMesh mesh_;
};

// A surface that is read later, on another thread.
struct LateSurface {
    std::size_t triangle_count = 0;
    std::function<void(MeshCollector&)> add_to;
};
std::shared_ptr<TriangleSource> source_of(std::vector<LateSurface> surfaces);

// The bytes of one surface. A corner's place comes first in them, all places together: three floats, or in a
// compressed surface four 16-bit numbers, of which three are shares of the box.
struct SurfaceBytes {
    std::span<const std::uint8_t> corners;
    std::span<const std::uint8_t> indices;  // 16 or 32 bits each; none: each corner in turn
    std::size_t corner_count = 0;
    std::size_t index_count = 0;
    bool compressed = false;
    PackedPlace box_corner{}, box_size{};  // that compressed corners are relative to
};

// Whether there are as many bytes as corners and indices need.
bool is_whole(const SurfaceBytes& bytes);
std::vector<PackedPlace> read_corners(const SurfaceBytes& bytes);
std::vector<std::int32_t> read_indices(const SurfaceBytes& bytes);

// The triangles of a strip, three indices each: every second one is turned round, and those that name a
// corner twice, by which strips are joined, are left out. Without indices, each of so many corners in turn.
std::vector<std::int32_t> triangles_of_strip(std::span<const std::int32_t> indices, std::size_t corner_count);

}  // namespace tactus
