// Godot's collision shapes as plain shapes. Scale is baked in: the result stands in a frame without any.
#pragma once

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/shape3d.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <string>
#include <vector>

#include "core/geometry/shape.hpp"
#include "nodes/mesh_source.hpp"

namespace tactus {

// A mesh whose tree is still to be built, or to be shared with who has built it.
struct MeshDraft {
    std::shared_ptr<MeshSource> source;
    godot::Basis scaling;       // applied to the triangles
    Pose pose;                  // of the scaled mesh in the body's frame
    double smooth_below = 0.0;  // see MeshShape
    bool one_sided = false;     // likewise
    std::string owner;          // the node's name, for what there is to say of the triangles
};

struct ShapeReading {
    std::vector<PlacedShape> shapes;  // this or the next has one entry, or both none on an error
    std::vector<MeshDraft> meshes;
    std::string error;  // what is wrong and what to do
};

// `transform` places the shape, scale included, in the frame of its body.
ShapeReading read_shape(const godot::Ref<godot::Shape3D>& shape, const godot::Transform3D& transform);

// Whether the two are the same surfaces at the same places.
bool same_shapes(const std::vector<PlacedShape>& a, const std::vector<PlacedShape>& b);
bool same_meshes(const std::vector<MeshDraft>& a, const std::vector<MeshDraft>& b);

}  // namespace tactus
