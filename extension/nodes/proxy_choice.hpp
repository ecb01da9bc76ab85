// Which hand a node listens or speaks to, a ProxyPointer or a HapticTool: the one that its path names; where
// that is empty, the one above it, or the first of its world. Main thread only.
#pragma once

#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/string.hpp>

namespace tactus {

// Null: there is none.
const godot::Node3D* chosen_hand(const godot::Node& node, const godot::NodePath& path);

// Why there is none, and what to do; empty where there is one.
godot::String problem_of_hand(const godot::Node& node, const godot::NodePath& path);

// Whether it is a ProxyPointer or a HapticTool.
bool is_hand(const godot::Node* node);

}  // namespace tactus
