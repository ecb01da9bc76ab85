#include "world/mesh_collector.hpp"

#include <bit>
#include <cstring>
#include <utility>

namespace tactus {

namespace {

constexpr std::size_t bytes_of_place = 3 * sizeof(float);
constexpr std::size_t bytes_of_compressed_place = 4 * sizeof(std::uint16_t);
constexpr float whole_share = 65535.0F;

}  // namespace

std::size_t MeshCollector::PlaceHash::operator()(const Vec3& v) const {
    const auto mix = [](std::size_t seed, double x) {
        return (seed ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e37'79b9'7f4a'7c15u;  // + 0.0: -0 is 0
    };
    const std::size_t hash = mix(mix(mix(0, v.x), v.y), v.z);
    return hash ^ (hash >> 32);
}

std::uint32_t MeshCollector::vertex_at(const Vec3& place) {
    const auto [entry, is_new] =
        vertices_.try_emplace(place, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) {
        mesh_.vertices.push_back(place);
    }
    return entry->second;
}

void MeshCollector::add(std::span<const PackedPlace> corners, std::span<const std::int32_t> indices) {
    std::vector<std::uint32_t> vertex_of(corners.size());
    vertices_.reserve(vertices_.size() + vertex_of.size() / 2);
    for (std::size_t i = 0; i < vertex_of.size(); ++i) {
        vertex_of[i] = vertex_at({corners[i][0], corners[i][1], corners[i][2]});
    }
    // An index without a corner stays one: check_mesh() says so.
    const auto vertex = [&](std::size_t i) {
        const std::size_t corner = indices.empty() ? i : static_cast<std::size_t>(indices[i]);
        return corner < vertex_of.size() ? vertex_of[corner] : 0xffff'ffffu;
    };
    const std::size_t count = (indices.empty() ? corners.size() : indices.size()) / 3 * 3;
    mesh_.triangles.reserve(mesh_.triangles.size() + count / 3);
    for (std::size_t i = 0; i < count; i += 3) {
        mesh_.triangles.push_back({vertex(i), vertex(i + 2), vertex(i + 1)});
    }
}

bool is_whole(const SurfaceBytes& bytes) {
    const std::size_t a_place = bytes.compressed ? bytes_of_compressed_place : bytes_of_place;
    return bytes.corners.size() >= a_place * bytes.corner_count &&
           (bytes.indices.size() == 2 * bytes.index_count || bytes.indices.size() == 4 * bytes.index_count);
}

std::vector<PackedPlace> read_corners(const SurfaceBytes& bytes) {
    std::vector<PackedPlace> corners(bytes.corner_count);
    if (!bytes.compressed && !corners.empty()) {
        std::memcpy(corners.data(), bytes.corners.data(), corners.size() * bytes_of_place);
        return corners;
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
        std::uint16_t share[3];
        std::memcpy(share, bytes.corners.data() + i * bytes_of_compressed_place, sizeof(share));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corners[i][axis] =
                static_cast<float>(share[axis]) / whole_share * bytes.box_size[axis] + bytes.box_corner[axis];
        }
    }
    return corners;
}

std::vector<std::int32_t> read_indices(const SurfaceBytes& bytes) {
    std::vector<std::int32_t> indices(bytes.index_count);
    const bool is_short = bytes.indices.size() == 2 * bytes.index_count;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        std::uint16_t index = 0;
        if (is_short) {
            std::memcpy(&index, bytes.indices.data() + 2 * i, sizeof(index));
            indices[i] = index;
        } else {
            std::memcpy(&indices[i], bytes.indices.data() + 4 * i, sizeof(std::int32_t));
        }
    }
    return indices;
}

}  // namespace tactus
