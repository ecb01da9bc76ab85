// Godot's collision shapes as plain shapes. Scale is baked in: the result stands in a frame without any.
#pragma once

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/shape3d.hpp>
#include <godot_cpp/variant/rid.hpp>

#include "world/scaled_shape.hpp"
#include "world/scene_frame.hpp"

namespace tactus {

// `frame` places the shape, scale included, in its body.
ShapeReading read_shape(const godot::Ref<godot::Shape3D>& shape, const SceneFrame& frame);

// The same of a shape that only the PhysicsServer3D knows.
ShapeReading read_server_shape(const godot::RID& shape, const SceneFrame& frame);

}  // namespace tactus
