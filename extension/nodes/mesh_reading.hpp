// Triangles out of Godot's meshes.
#pragma once

#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/basis.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "core/geometry/triangle_mesh.hpp"

namespace tactus {

// Three corners a triangle, as Godot's get_faces() gives them. Godot's front faces are clockwise, ours
// counter-clockwise. Corners at the same place become one vertex, so that neighbours know each other.
TriangleMesh mesh_from_faces(const godot::PackedVector3Array& faces);

TriangleMesh mesh_from_resource(const godot::Ref<godot::Mesh>& mesh);

// Scaled, mirrored or sheared; the triangles of a mirrored mesh are turned over so that outside stays
// outside.
TriangleMesh scaled(TriangleMesh mesh, const godot::Basis& scaling);

}  // namespace tactus
