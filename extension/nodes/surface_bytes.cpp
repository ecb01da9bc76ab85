#include "nodes/surface_bytes.hpp"

#include <cstring>
#include <godot_cpp/classes/rendering_server.hpp>
#include <godot_cpp/variant/dictionary.hpp>

namespace tactus {

using namespace godot;

namespace {

// A corner's place comes first in the vertex data, all places together: three floats, or in a compressed
// surface four 16-bit numbers, of which three are shares of the box.
constexpr std::int64_t bytes_of_place = 3 * sizeof(float);
constexpr std::int64_t bytes_of_compressed_place = 4 * sizeof(std::uint16_t);
constexpr std::int64_t known_version = 1;  // of the layout: Godot 4.2 to 4.6
constexpr float whole_share = 65535.0F;

}  // namespace

std::optional<SurfaceBytes> SurfaceBytes::take(const Ref<Mesh>& mesh, int surface) {
    const Dictionary data = RenderingServer::get_singleton()->mesh_get_surface(mesh->get_rid(), surface);
    const std::int64_t format = data.get("format", 0);
    const std::int64_t version = format >> RenderingServer::ARRAY_FLAG_FORMAT_VERSION_SHIFT &
                                 RenderingServer::ARRAY_FLAG_FORMAT_VERSION_MASK;
    if (version != known_version || (format & RenderingServer::ARRAY_FORMAT_VERTEX) == 0 ||
        (format & RenderingServer::ARRAY_FLAG_USE_2D_VERTICES) != 0) {
        return std::nullopt;
    }
    SurfaceBytes bytes;
    bytes.corner_bytes_ = data.get("vertex_data", PackedByteArray());
    bytes.index_bytes_ = data.get("index_data", PackedByteArray());
    bytes.corner_count_ = data.get("vertex_count", 0);
    bytes.index_count_ = data.get("index_count", 0);
    bytes.compressed_ = (format & RenderingServer::ARRAY_FLAG_COMPRESS_ATTRIBUTES) != 0;
    bytes.box_ = data.get("aabb", AABB());
    const std::int64_t a_place = bytes.compressed_ ? bytes_of_compressed_place : bytes_of_place;
    const std::int64_t of_indices = bytes.index_bytes_.size();
    const bool is_known = bytes.corner_bytes_.size() >= a_place * bytes.corner_count_ &&
                          (of_indices == 2 * bytes.index_count_ || of_indices == 4 * bytes.index_count_);
    return is_known ? std::optional(std::move(bytes)) : std::nullopt;
}

PackedVector3Array SurfaceBytes::corners() const {
    PackedVector3Array corners;
    corners.resize(corner_count_);
    Vector3* to = corners.ptrw();
    const std::uint8_t* from = corner_bytes_.ptr();
    for (std::int64_t i = 0; i < corner_count_; ++i) {
        if (compressed_) {
            std::uint16_t share[3];
            std::memcpy(share, from + i * bytes_of_compressed_place, sizeof(share));
            const Vector3 place(static_cast<real_t>(share[0]), static_cast<real_t>(share[1]),
                                static_cast<real_t>(share[2]));
            to[i] = place / whole_share * box_.size + box_.position;
        } else {
            float place[3];
            std::memcpy(place, from + i * bytes_of_place, sizeof(place));
            to[i] = Vector3(place[0], place[1], place[2]);
        }
    }
    return corners;
}

PackedInt32Array SurfaceBytes::indices() const {
    PackedInt32Array indices;
    indices.resize(index_count_);
    std::int32_t* to = indices.ptrw();
    const std::uint8_t* from = index_bytes_.ptr();
    const bool is_short = index_bytes_.size() == 2 * index_count_;
    for (std::int64_t i = 0; i < index_count_; ++i) {
        std::uint16_t index = 0;
        if (is_short) {
            std::memcpy(&index, from + 2 * i, sizeof(index));
            to[i] = index;
        } else {
            std::memcpy(to + i, from + 4 * i, sizeof(std::int32_t));
        }
    }
    return indices;
}

}  // namespace tactus
