// Small meshes for the eye: what the nodes show of proxies, hands and paths.
#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/standard_material3d.hpp>
#include <godot_cpp/variant/color.hpp>
#include <vector>

#include "core/geometry/triangle_mesh.hpp"
#include "core/math/types.hpp"

namespace tactus {

// The same triangles with flat shading.
godot::Ref<godot::ArrayMesh> drawn_mesh(const TriangleMesh& mesh);

// A round tube along the points, for lines that stay visible from anywhere (unit of thickness: meters).
godot::Ref<godot::ArrayMesh> tube_mesh(const std::vector<Vec3>& points, double thickness, bool closed);

// Lit like everything else; or bright, and seen through whatever stands before it.
godot::Ref<godot::StandardMaterial3D> lit_material(const godot::Color& color);
godot::Ref<godot::StandardMaterial3D> see_through_material(const godot::Color& color);

}  // namespace tactus
