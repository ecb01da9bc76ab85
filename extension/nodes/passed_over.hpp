// What Godot's physics has and a world does not carry out, found where a scene uses it (docs/godot_physics.md
// lists all of it). Main thread only.
#pragma once

#include <godot_cpp/classes/node.hpp>
#include <string>
#include <vector>

namespace tactus {

// Of one node of a world: what of it is used and not carried out, and what to do instead; empty where all of
// it is.
std::vector<std::string> passed_over(const godot::Node& node);

}  // namespace tactus
