// Triangles out of Godot's meshes.
#pragma once

#include <cstdint>
#include <godot_cpp/variant/basis.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <unordered_map>

#include "core/geometry/triangle_mesh.hpp"

namespace tactus {

// Puts the surfaces of a mesh together. Godot's front faces are clockwise, ours counter-clockwise. Corners at
// the same place become one vertex, so that neighbours know each other.
class MeshCollector {
public:
    // Three corners a triangle; without indices, each corner in turn.
    void add(const godot::PackedVector3Array& corners, const godot::PackedInt32Array& indices);
    TriangleMesh take() { return std::move(mesh_); }

private:
    struct PlaceHash {
        std::size_t operator()(const Vec3& v) const;
    };
    std::uint32_t vertex_at(const Vec3& place);

    TriangleMesh mesh_;
    std::unordered_map<Vec3, std::uint32_t, PlaceHash> vertices_;
};

// Scaled, mirrored or sheared; the triangles of a mirrored mesh are turned over so that outside stays
// outside.
TriangleMesh scaled(TriangleMesh mesh, const godot::Basis& scaling);

}  // namespace tactus
