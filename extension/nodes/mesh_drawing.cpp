#include "nodes/mesh_drawing.hpp"

#include <glm/geometric.hpp>
#include <godot_cpp/variant/array.hpp>

#include "core/geometry/smooth_normals.hpp"
#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

namespace {

// Flat ones are found at once, also of millions of triangles.
std::vector<CornerNormals> shading(const Drawing& drawing) {
    if (drawing.crease > 0.0) {
        return smooth_normals(drawing.mesh, drawing.crease);
    }
    std::vector<CornerNormals> normals;
    for (const auto& [a, b, c] : drawing.mesh.triangles) {
        const Vec3& corner = drawing.mesh.vertices[a];
        const Vec3 cross = glm::cross(drawing.mesh.vertices[b] - corner, drawing.mesh.vertices[c] - corner);
        const double area = glm::length(cross);
        const glm::vec3 normal(area > 0.0 ? cross / area : cross);
        normals.push_back({normal, normal, normal});
    }
    return normals;
}

}  // namespace

Ref<ArrayMesh> drawn_mesh(const Drawing& drawing) {
    const TriangleMesh& mesh = drawing.mesh;
    const std::vector<CornerNormals> corner_normals = shading(drawing);
    PackedVector3Array vertices;
    PackedVector3Array normals;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const std::size_t corner : {0u, 2u, 1u}) {  // Godot draws what runs clockwise
            vertices.push_back(to_godot(mesh.vertices[mesh.triangles[i][corner]]));
            normals.push_back(to_godot(Vec3(corner_normals[i][corner])));
        }
    }
    Ref<ArrayMesh> drawn;
    drawn.instantiate();
    if (!vertices.is_empty()) {
        Array arrays;
        arrays.resize(Mesh::ARRAY_MAX);
        arrays[Mesh::ARRAY_VERTEX] = vertices;
        arrays[Mesh::ARRAY_NORMAL] = normals;
        drawn->add_surface_from_arrays(Mesh::PRIMITIVE_TRIANGLES, arrays);
    }
    return drawn;
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
