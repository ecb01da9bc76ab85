#include "nodes/mesh_reading.hpp"

#include <bit>
#include <utility>
#include <vector>

#include "nodes/conversions.hpp"

namespace tactus {

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

void MeshCollector::add(const godot::PackedVector3Array& corners, const godot::PackedInt32Array& indices) {
    std::vector<std::uint32_t> vertex_of(static_cast<std::size_t>(corners.size()));
    vertices_.reserve(vertices_.size() + vertex_of.size() / 2);
    const godot::Vector3* places = corners.ptr();
    for (std::size_t i = 0; i < vertex_of.size(); ++i) {
        vertex_of[i] = vertex_at(from_godot(places[i]));
    }
    const int32_t* index = indices.ptr();
    const bool indexed = !indices.is_empty();
    // An index without a corner stays one: check_mesh() says so.
    const auto vertex = [&](std::int64_t i) {
        const auto corner = static_cast<std::size_t>(indexed ? index[i] : i);
        return corner < vertex_of.size() ? vertex_of[corner] : 0xffff'ffffu;
    };
    const std::int64_t count = (indexed ? indices.size() : corners.size()) / 3 * 3;
    mesh_.triangles.reserve(mesh_.triangles.size() + static_cast<std::size_t>(count / 3));
    for (std::int64_t i = 0; i < count; i += 3) {
        mesh_.triangles.push_back({vertex(i), vertex(i + 2), vertex(i + 1)});
    }
}

TriangleMesh scaled(TriangleMesh mesh, const godot::Basis& scaling) {
    const Vec3 x = from_godot(scaling.get_column(0));
    const Vec3 y = from_godot(scaling.get_column(1));
    const Vec3 z = from_godot(scaling.get_column(2));
    for (Vec3& vertex : mesh.vertices) {
        vertex = x * vertex.x + y * vertex.y + z * vertex.z;
    }
    if (scaling.determinant() < 0) {
        for (auto& triangle : mesh.triangles) {
            std::swap(triangle[1], triangle[2]);
        }
    }
    return mesh;
}

}  // namespace tactus
