// Godot's collision shapes as plain shapes. Scale is baked in: the result stands in a frame without any.
#pragma once

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/shape3d.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <string>
#include <vector>

#include "core/geometry/shape.hpp"

namespace tactus {

struct ShapeReading {
    std::vector<PlacedShape> shapes;  // one, or none on an error
    std::string error;                // what is wrong and what to do
};

// `transform` places the shape, scale included, in the frame of its body.
ShapeReading read_shape(const godot::Ref<godot::Shape3D>& shape, const godot::Transform3D& transform);

// Whether the two are the same surfaces at the same places.
bool same_shapes(const std::vector<PlacedShape>& a, const std::vector<PlacedShape>& b);

}  // namespace tactus
