#include "nodes/mesh_source.hpp"

#include <algorithm>
#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/primitive_mesh.hpp>
#include <godot_cpp/classes/rendering_server.hpp>
#include <godot_cpp/variant/aabb.hpp>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/packed_byte_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <optional>
#include <vector>

#include "world/mesh_collector.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr std::int64_t known_version = 1;  // of the layout of a surface's bytes: Godot 4.2 to 4.6

// What a packed array holds. Vectors are seen as the floats that they are made of.
template <class Value, class Packed>
std::span<const Value> span_of(const Packed& packed) {
    static_assert(sizeof(Value) == sizeof(*packed.ptr()), "a Godot of single precision");
    return {reinterpret_cast<const Value*>(packed.ptr()), static_cast<std::size_t>(packed.size())};
}

PackedPlace place_of(const Vector3& v) {
    return {v.x, v.y, v.z};
}

LateSurface surface_of(const PackedVector3Array& corners, const PackedInt32Array& indices) {
    const auto named = static_cast<std::size_t>(indices.is_empty() ? corners.size() : indices.size());
    return {named / 3, [corners, indices](MeshCollector& collector) {
                collector.add(span_of<PackedPlace>(corners), span_of<std::int32_t>(indices));
            }};
}

// Taken as bytes, a surface costs the main thread little: Mesh::surface_get_arrays() decodes them, 100 ms for
// two million triangles.
// Nothing where the surface is not laid out as known here.
std::optional<LateSurface> raw_surface(const Ref<Mesh>& mesh, int surface) {
    const Dictionary data = RenderingServer::get_singleton()->mesh_get_surface(mesh->get_rid(), surface);
    const std::int64_t format = data.get("format", 0);
    const std::int64_t version = format >> RenderingServer::ARRAY_FLAG_FORMAT_VERSION_SHIFT &
                                 RenderingServer::ARRAY_FLAG_FORMAT_VERSION_MASK;
    if (version != known_version || (format & RenderingServer::ARRAY_FORMAT_VERTEX) == 0 ||
        (format & RenderingServer::ARRAY_FLAG_USE_2D_VERTICES) != 0) {
        return std::nullopt;
    }
    const PackedByteArray corners = data.get("vertex_data", PackedByteArray());
    const PackedByteArray indices = data.get("index_data", PackedByteArray());
    const AABB box = data.get("aabb", AABB());
    const std::int64_t corner_count = data.get("vertex_count", 0);
    const std::int64_t index_count = data.get("index_count", 0);
    const SurfaceBytes bytes{.corners = span_of<std::uint8_t>(corners),
                             .indices = span_of<std::uint8_t>(indices),
                             .corner_count = static_cast<std::size_t>(corner_count),
                             .index_count = static_cast<std::size_t>(index_count),
                             .compressed = (format & RenderingServer::ARRAY_FLAG_COMPRESS_ATTRIBUTES) != 0,
                             .box_corner = place_of(box.position),
                             .box_size = place_of(box.size)};
    if (!is_whole(bytes)) {
        return std::nullopt;
    }
    return LateSurface{(bytes.index_count == 0 ? bytes.corner_count : bytes.index_count) / 3,
                       [corners, indices, bytes](MeshCollector& collector) {
                           collector.add(read_corners(bytes), read_indices(bytes));
                       }};
}

Mesh::PrimitiveType primitive_of(const Ref<Mesh>& mesh, int surface) {
    if (const auto* arrays = Object::cast_to<ArrayMesh>(mesh.ptr())) {
        return arrays->surface_get_primitive_type(surface);
    }
    return mesh->get_class() == "PointMesh" ? Mesh::PRIMITIVE_POINTS : Mesh::PRIMITIVE_TRIANGLES;
}

// Whether its surfaces are read one by one. Others have only get_faces().
bool has_surfaces(const Ref<Mesh>& mesh) {
    return Object::cast_to<PrimitiveMesh>(mesh.ptr()) != nullptr ||
           Object::cast_to<ArrayMesh>(mesh.ptr()) != nullptr;
}

}  // namespace

std::optional<SurfaceCorners> corners_of(const Ref<Mesh>& mesh, int surface) {
    const Mesh::PrimitiveType primitive = primitive_of(mesh, surface);
    if (primitive != Mesh::PRIMITIVE_TRIANGLES && primitive != Mesh::PRIMITIVE_TRIANGLE_STRIP) {
        return std::nullopt;
    }
    const Array arrays = mesh->surface_get_arrays(surface);
    SurfaceCorners result{arrays[Mesh::ARRAY_VERTEX], arrays[Mesh::ARRAY_INDEX], arrays[Mesh::ARRAY_TEX_UV]};
    if (primitive == Mesh::PRIMITIVE_TRIANGLE_STRIP) {
        const std::vector<std::int32_t> list = triangles_of_strip(
            span_of<std::int32_t>(result.indices), static_cast<std::size_t>(result.corners.size()));
        if (list.empty()) {
            return std::nullopt;
        }
        result.indices.resize(static_cast<int64_t>(list.size()));
        std::ranges::copy(list, result.indices.ptrw());
    }
    return result;
}

// Godot's get_faces() builds a tree of its own: for a large mesh that takes seconds.
std::shared_ptr<TriangleSource> source_of(const Ref<Mesh>& mesh) {
    if (!has_surfaces(mesh)) {
        return source_of(mesh->get_faces());
    }
    std::vector<LateSurface> surfaces;
    for (int32_t i = 0; i < mesh->get_surface_count(); ++i) {
        std::optional<LateSurface> raw =
            primitive_of(mesh, i) == Mesh::PRIMITIVE_TRIANGLES ? raw_surface(mesh, i) : std::nullopt;
        if (raw) {
            surfaces.push_back(std::move(*raw));
        } else if (const std::optional<SurfaceCorners> read = corners_of(mesh, i)) {
            surfaces.push_back(surface_of(read->corners, read->indices));
        }
    }
    return source_of(std::move(surfaces));
}

std::shared_ptr<const SurfaceMap> surface_map_of(const Ref<Mesh>& mesh, const SurfaceParts& parts) {
    auto map = std::make_shared<SurfaceMap>();
    for (int32_t i = 0; has_surfaces(mesh) && i < mesh->get_surface_count(); ++i) {
        if (const std::optional<SurfaceCorners> read = corners_of(mesh, i)) {
            add(*map,
                {static_cast<std::size_t>(i), span_of<PackedPlace>(read->corners).size(),
                 span_of<std::int32_t>(read->indices), span_of<std::array<float, 2>>(read->uv)},
                parts);
        }
    }
    return parts_of(*map) == SurfaceParts() ? nullptr : map;
}

std::shared_ptr<TriangleSource> source_of(const PackedVector3Array& faces) {
    return source_of(std::vector<LateSurface>{surface_of(faces, PackedInt32Array())});
}

}  // namespace tactus
