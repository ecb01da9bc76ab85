#include "nodes/mesh_reading.hpp"

#include <utility>
#include <vector>

#include "core/geometry/same_places.hpp"
#include "nodes/conversions.hpp"

namespace tactus {

void MeshCollector::add(const godot::PackedVector3Array& corners, const godot::PackedInt32Array& indices) {
    const std::size_t before = mesh_.vertices.size();
    const auto corner_count = static_cast<std::size_t>(corners.size());
    const godot::Vector3* places = corners.ptr();
    mesh_.vertices.reserve(before + corner_count);
    for (std::size_t i = 0; i < corner_count; ++i) {
        mesh_.vertices.push_back(from_godot(places[i]));
    }
    const int32_t* index = indices.ptr();
    const bool indexed = !indices.is_empty();
    // An index without a corner stays one: check_mesh() says so.
    const auto vertex = [&](std::int64_t i) {
        const auto corner = static_cast<std::size_t>(indexed ? index[i] : i);
        return corner < corner_count ? static_cast<std::uint32_t>(before + corner) : 0xffff'ffffu;
    };
    const std::int64_t count = (indexed ? indices.size() : corners.size()) / 3 * 3;
    mesh_.triangles.reserve(mesh_.triangles.size() + static_cast<std::size_t>(count / 3));
    for (std::int64_t i = 0; i < count; i += 3) {
        mesh_.triangles.push_back({vertex(i), vertex(i + 2), vertex(i + 1)});
    }
}

TriangleMesh MeshCollector::take() {
    merge_places(mesh_);
    return std::move(mesh_);
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
