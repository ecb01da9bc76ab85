#include "nodes/mesh_drawing.hpp"

#include <godot_cpp/variant/array.hpp>

#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

void add_surface(ArrayMesh& mesh, Mesh::PrimitiveType kind, const SurfaceArrays& arrays) {
    if (arrays.places.is_empty()) {
        return;
    }
    Array all;
    all.resize(Mesh::ARRAY_MAX);
    all[Mesh::ARRAY_VERTEX] = arrays.places;
    if (!arrays.normals.is_empty()) {
        all[Mesh::ARRAY_NORMAL] = arrays.normals;
    }
    if (!arrays.indices.is_empty()) {
        all[Mesh::ARRAY_INDEX] = arrays.indices;
    }
    mesh.add_surface_from_arrays(kind, all);
}

Ref<ArrayMesh> drawn_mesh(const Drawing& drawing) {
    const DrawnCorners corners = corners_of(drawing);
    Ref<ArrayMesh> drawn;
    drawn.instantiate();
    add_surface(**drawn, Mesh::PRIMITIVE_TRIANGLES, {packed(corners.places), packed(corners.normals)});
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

Ref<StandardMaterial3D> point_material(const Color& color, float size) {
    Ref<StandardMaterial3D> material = lit_material(color);
    material->set_shading_mode(BaseMaterial3D::SHADING_MODE_UNSHADED);
    material->set_flag(BaseMaterial3D::FLAG_USE_POINT_SIZE, true);
    material->set_point_size(size);
    return material;
}

MeshInstance3D* add_picture(Node& to, const Ref<Mesh>& mesh, const Ref<Material>& look) {
    MeshInstance3D* picture = memnew(MeshInstance3D);
    picture->set_mesh(mesh);
    picture->set_material_override(look);
    picture->set_cast_shadows_setting(GeometryInstance3D::SHADOW_CASTING_SETTING_OFF);
    to.add_child(picture, false, Node::INTERNAL_MODE_BACK);
    return picture;
}

MeshInstance3D* add_picture(Node& to, const Drawing& drawing, const Ref<Material>& look) {
    return add_picture(to, Ref<Mesh>(drawn_mesh(drawing)), look);
}

}  // namespace tactus
