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

godot::Ref<godot::StandardMaterial3D> plain_material(const godot::Color& color, bool lit);

}  // namespace tactus
