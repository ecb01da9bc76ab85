// What Godot hears of a hand that has no device of its own: mouse, keys, gamepad, a node that somebody moves.
// Main thread only.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/variant/string.hpp>

#include "devices/steering.hpp"

namespace tactus {

// The arrow keys, page up (away) and page down (closer), by their places on the keyboard; space is button 0,
// enter is button 1.
SteeringInput read_keyboard();

// The left stick goes right and up, the right one away and closer.
SteeringInput read_gamepad(int gamepad);

// Of an XRController3D: trigger, grip, and the two of the thumb. Any other node has none.
std::uint32_t buttons_of(const godot::Node3D& node);

// A direction of the view (right, up, towards the camera) in the scene; by the node's own axes where there is
// no camera.
Vec3 from_view(const godot::Node3D& node, const Vec3& direction);

// Why the hand cannot be moved so, and what to do; empty where it can.
godot::String problem_of_mouse(const godot::Node& node);
godot::String problem_of_gamepad(int gamepad);

}  // namespace tactus
