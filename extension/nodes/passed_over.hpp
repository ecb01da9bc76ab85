// What Godot's physics has and a world does not carry out, found where a scene uses it (docs/godot_physics.md
// lists all of it). Main thread only.
#pragma once

#include <godot_cpp/classes/node.hpp>
#include <string>
#include <vector>

namespace tactus {

// Of one node of a world: what of it is used and not carried out, and what to do instead; empty where all of
// it is. `engine_moves`: Godot's own physics moves the bodies of that world.
std::vector<std::string> passed_over(const godot::Node& node, bool engine_moves);

// Why the node's scene expects Godot's own physics to move its bodies; empty where it does not.
std::string need_of_godot(const godot::Node& node);

}  // namespace tactus
