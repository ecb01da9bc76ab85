// Triangles out of Godot's meshes.
#pragma once

#include <cstdint>
#include <godot_cpp/variant/basis.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "core/geometry/triangle_mesh.hpp"

namespace tactus {

// Puts the surfaces of a mesh together. Godot's front faces are clockwise, ours counter-clockwise. Corners at
// the same place become one vertex, so that neighbours know each other.
class MeshCollector {
public:
    // Three corners a triangle; without indices, each corner in turn.
    void add(const godot::PackedVector3Array& corners, const godot::PackedInt32Array& indices);
    TriangleMesh take();

private:
    TriangleMesh mesh_;
};

// Scaled, mirrored or sheared; the triangles of a mirrored mesh are turned over so that outside stays
// outside.
TriangleMesh scaled(TriangleMesh mesh, const godot::Basis& scaling);

}  // namespace tactus
