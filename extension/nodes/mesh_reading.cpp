#include "nodes/mesh_reading.hpp"

#include <bit>
#include <unordered_map>
#include <utility>

#include "nodes/conversions.hpp"

namespace tactus {

namespace {

struct PlaceHash {
    std::size_t operator()(const Vec3& v) const {
        const auto mix = [](std::size_t seed, double x) {
            return (seed ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e37'79b9'7f4a'7c15u;  // + 0.0: -0 is 0
        };
        const std::size_t hash = mix(mix(mix(0, v.x), v.y), v.z);
        return hash ^ (hash >> 32);
    }
};

}  // namespace

TriangleMesh mesh_from_faces(const godot::PackedVector3Array& faces) {
    TriangleMesh mesh;
    std::unordered_map<Vec3, std::uint32_t, PlaceHash> vertex_at;
    const godot::Vector3* corners = faces.ptr();
    for (std::int64_t i = 0; i + 2 < faces.size(); i += 3) {
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 place = from_godot(corners[i + static_cast<std::int64_t>(k)]);
            const auto [entry, is_new] =
                vertex_at.try_emplace(place, static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new) {
                mesh.vertices.push_back(place);
            }
            triangle[k] = entry->second;
        }
        mesh.triangles.push_back({triangle[0], triangle[2], triangle[1]});
    }
    return mesh;
}

TriangleMesh mesh_from_resource(const godot::Ref<godot::Mesh>& mesh) {
    return mesh.is_valid() ? mesh_from_faces(mesh->get_faces()) : TriangleMesh{};
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
