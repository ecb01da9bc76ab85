#include "world/mesh_collector.hpp"

#include <cstring>
#include <utility>

#include "core/mesh/same_places.hpp"

namespace tactus {

namespace {

constexpr std::size_t bytes_of_place = 3 * sizeof(float);
constexpr std::size_t bytes_of_compressed_place = 4 * sizeof(std::uint16_t);
constexpr float whole_share = 65535.0F;

}  // namespace

void MeshCollector::add(std::span<const PackedPlace> corners, std::span<const std::int32_t> indices) {
    const std::size_t before = mesh_.vertices.size();
    mesh_.vertices.reserve(before + corners.size());
    for (const PackedPlace& place : corners) {
        mesh_.vertices.emplace_back(place[0], place[1], place[2]);
    }
    // An index without a corner stays one: check_mesh() says so.
    const auto vertex = [&](std::size_t i) {
        const std::size_t corner = indices.empty() ? i : static_cast<std::size_t>(indices[i]);
        return corner < corners.size() ? static_cast<std::uint32_t>(before + corner) : 0xffff'ffffu;
    };
    const std::size_t count = (indices.empty() ? corners.size() : indices.size()) / 3 * 3;
    mesh_.triangles.reserve(mesh_.triangles.size() + count / 3);
    for (std::size_t i = 0; i < count; i += 3) {
        mesh_.triangles.push_back({vertex(i), vertex(i + 2), vertex(i + 1)});
    }
}

TriangleSource::Read MeshCollector::take() {
    std::vector<std::uint32_t> merged = merge_places(mesh_);
    TriangleSource::Read read(std::move(mesh_));
    read.merged = std::move(merged);
    return read;
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

std::vector<std::int32_t> triangles_of_strip(std::span<const std::int32_t> indices,
                                             std::size_t corner_count) {
    const std::size_t count = indices.empty() ? corner_count : indices.size();
    const auto corner = [&](std::size_t i) {
        return indices.empty() ? static_cast<std::int32_t>(i) : indices[i];
    };
    std::vector<std::int32_t> list;
    for (std::size_t i = 0; i + 2 < count; ++i) {
        const std::int32_t a = corner(i);
        const std::int32_t b = corner(i + 1 + i % 2);
        const std::int32_t c = corner(i + 2 - i % 2);
        if (a != b && b != c && c != a) {
            list.insert(list.end(), {a, b, c});
        }
    }
    return list;
}

std::shared_ptr<TriangleSource> source_of(std::vector<LateSurface> surfaces) {
    std::size_t count = 0;
    for (const LateSurface& surface : surfaces) {
        count += surface.triangle_count;
    }
    auto read = [surfaces = std::move(surfaces)] {
        MeshCollector collector;
        for (const LateSurface& surface : surfaces) {
            surface.add_to(collector);
        }
        return collector.take();
    };
    return std::make_shared<TriangleSource>(std::move(read), count);
}

}  // namespace tactus
