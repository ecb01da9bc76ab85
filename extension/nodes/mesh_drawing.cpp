#include "nodes/mesh_drawing.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <godot_cpp/variant/array.hpp>
#include <numbers>

#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr int tube_sides = 6;

Ref<ArrayMesh> one_surface(const PackedVector3Array& vertices, const PackedVector3Array& normals,
                           const PackedInt32Array& indices) {
    Ref<ArrayMesh> mesh;
    mesh.instantiate();
    if (vertices.is_empty()) {
        return mesh;
    }
    Array arrays;
    arrays.resize(Mesh::ARRAY_MAX);
    arrays[Mesh::ARRAY_VERTEX] = vertices;
    arrays[Mesh::ARRAY_NORMAL] = normals;
    if (!indices.is_empty()) {
        arrays[Mesh::ARRAY_INDEX] = indices;
    }
    mesh->add_surface_from_arrays(Mesh::PRIMITIVE_TRIANGLES, arrays);
    return mesh;
}

Vec3 any_perpendicular(const Vec3& direction) {
    const Vec3 other = std::abs(direction.y) < 0.9 ? Vec3(0.0, 1.0, 0.0) : Vec3(1.0, 0.0, 0.0);
    return glm::normalize(glm::cross(direction, other));
}

Vec3 direction_at(const std::vector<Vec3>& points, std::size_t i, bool closed) {
    const std::size_t last = points.size() - 1;
    const Vec3& before = i > 0 ? points[i - 1] : points[closed ? last : 0];
    const Vec3& after = i < last ? points[i + 1] : points[closed ? 0 : last];
    const Vec3 way = after - before;
    const double length = glm::length(way);
    return length > 0.0 ? way / length : Vec3(1.0, 0.0, 0.0);
}

}  // namespace

Ref<ArrayMesh> drawn_mesh(const TriangleMesh& mesh) {
    PackedVector3Array vertices;
    PackedVector3Array normals;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 cross = glm::cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
        const double area = glm::length(cross);
        const Vector3 normal = to_godot(area > 0.0 ? cross / area : cross);
        for (const std::uint32_t corner : {a, c, b}) {  // Godot draws what runs clockwise
            vertices.push_back(to_godot(mesh.vertices[corner]));
            normals.push_back(normal);
        }
    }
    return one_surface(vertices, normals, PackedInt32Array());
}

Ref<ArrayMesh> tube_mesh(const std::vector<Vec3>& points, double thickness, bool closed) {
    PackedVector3Array vertices;
    PackedVector3Array normals;
    PackedInt32Array indices;
    if (points.size() < 2) {
        return one_surface(vertices, normals, indices);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 along = direction_at(points, i, closed);
        const Vec3 u = any_perpendicular(along);
        const Vec3 v = glm::cross(along, u);
        for (int side = 0; side < tube_sides; ++side) {
            const double angle = 2.0 * std::numbers::pi * side / tube_sides;
            const Vec3 normal = std::cos(angle) * u + std::sin(angle) * v;
            vertices.push_back(to_godot(points[i] + 0.5 * thickness * normal));
            normals.push_back(to_godot(normal));
        }
    }
    const int rings = static_cast<int>(points.size());
    for (int ring = 0; ring < (closed ? rings : rings - 1); ++ring) {
        const int next = (ring + 1) % rings;
        for (int side = 0; side < tube_sides; ++side) {
            const int beside = (side + 1) % tube_sides;
            const int a = ring * tube_sides + side;
            const int b = ring * tube_sides + beside;
            const int c = next * tube_sides + side;
            const int d = next * tube_sides + beside;
            for (const int index : {a, c, b, b, c, d}) {
                indices.push_back(index);
            }
        }
    }
    return one_surface(vertices, normals, indices);
}

Ref<StandardMaterial3D> lit_material(const Color& color) {
    Ref<StandardMaterial3D> material;
    material.instantiate();
    material->set_albedo(color);
    return material;
}

Ref<StandardMaterial3D> see_through_material(const Color& color) {
    Ref<StandardMaterial3D> material = lit_material(color);
    material->set_shading_mode(BaseMaterial3D::SHADING_MODE_UNSHADED);
    material->set_flag(BaseMaterial3D::FLAG_DISABLE_DEPTH_TEST, true);
    // Transparent things are drawn last: nothing is drawn over them.
    material->set_transparency(BaseMaterial3D::TRANSPARENCY_ALPHA);
    return material;
}

}  // namespace tactus
