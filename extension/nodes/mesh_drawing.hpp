// Small meshes for the eye: what the nodes show of proxies, hands and paths.
#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/standard_material3d.hpp>
#include <godot_cpp/variant/color.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "world/drawn_shape.hpp"

namespace tactus {

godot::Ref<godot::ArrayMesh> drawn_mesh(const Drawing& drawing);

// What a mesh is made of: nothing where there are no places.
struct SurfaceArrays {
    godot::PackedVector3Array places;
    godot::PackedVector3Array normals = {};  // likewise indices: none where there are none
    godot::PackedInt32Array indices = {};
};
void add_surface(godot::ArrayMesh& mesh, godot::Mesh::PrimitiveType kind, const SurfaceArrays& arrays);

// Lit like everything else; or bright, and seen through whatever stands before it.
godot::Ref<godot::StandardMaterial3D> lit_material(const godot::Color& color);
godot::Ref<godot::StandardMaterial3D> see_through_material(const godot::Color& color);

// Bright; of meshes of points, each a square of that size (unit: pixels).
godot::Ref<godot::StandardMaterial3D> point_material(const godot::Color& color, float size);

// A child that the scene does not see and that throws no shadow.
godot::MeshInstance3D* add_picture(godot::Node& to, const godot::Ref<godot::Mesh>& mesh,
                                   const godot::Ref<godot::Material>& look);
godot::MeshInstance3D* add_picture(godot::Node& to, const Drawing& drawing,
                                   const godot::Ref<godot::Material>& look);

}  // namespace tactus
