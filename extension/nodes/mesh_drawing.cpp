#include "nodes/mesh_drawing.hpp"

#include <algorithm>
#include <godot_cpp/variant/array.hpp>

namespace tactus {

using namespace godot;

namespace {

PackedVector3Array packed(const std::vector<glm::vec3>& from) {
    PackedVector3Array to;
    to.resize(static_cast<int64_t>(from.size()));
    std::ranges::transform(from, to.ptrw(), [](const glm::vec3& v) { return Vector3(v.x, v.y, v.z); });
    return to;
}

}  // namespace

Ref<ArrayMesh> drawn_mesh(const Drawing& drawing) {
    const DrawnCorners corners = corners_of(drawing);
    Ref<ArrayMesh> drawn;
    drawn.instantiate();
    if (!corners.places.empty()) {
        Array arrays;
        arrays.resize(Mesh::ARRAY_MAX);
        arrays[Mesh::ARRAY_VERTEX] = packed(corners.places);
        arrays[Mesh::ARRAY_NORMAL] = packed(corners.normals);
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

MeshInstance3D* add_picture(Node& to, const Drawing& drawing, const Ref<Material>& look) {
    MeshInstance3D* picture = memnew(MeshInstance3D);
    picture->set_mesh(drawn_mesh(drawing));
    picture->set_material_override(look);
    picture->set_cast_shadows_setting(GeometryInstance3D::SHADOW_CASTING_SETTING_OFF);
    to.add_child(picture, false, Node::INTERNAL_MODE_BACK);
    return picture;
}

}  // namespace tactus
