// Godot's collision shapes as plain shapes. Scale is baked in: the result stands in a frame without any.
#pragma once

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/shape3d.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <string>
#include <vector>

#include "world/scaled_shape.hpp"

namespace tactus {

// `transform` places the shape, scale included, in the frame of its body.
ShapeReading read_shape(const godot::Ref<godot::Shape3D>& shape, const godot::Transform3D& transform);

}  // namespace tactus
