// What every scene needs, and warnings in the editor that keep up with what they say. Main thread only.
#pragma once

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/variant/string.hpp>

namespace tactus {

class HapticWorld;

// Why no HapticWorld runs this node, and what to do; empty where one does, or will when the scene plays.
godot::String problem_without_world(const godot::Node& node);

// Of a world without bodies below it: what to do.
godot::String problem_of_emptiness(const HapticWorld& world);

// In the editor: the node's warnings are asked for every half second, and shown anew when they are other
// ones. In the game: says once, when the first frames have passed, that there is no world.
void watch_warnings(godot::Node& node);

// Why this node of a world cannot be touched, though it looks as if it could; empty where that does not
// apply.
godot::String problem_of_kind(const godot::Node& node);

}  // namespace tactus
