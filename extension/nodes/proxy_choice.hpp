// Which fingertip a node listens or speaks to: the one that its path names; where that is empty, the one
// above it, or the first of its world. Main thread only.
#pragma once

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/string.hpp>

namespace tactus {

class ProxyPointer;

const ProxyPointer* chosen_proxy(const godot::Node& node, const godot::NodePath& path);

// Why there is none, and what to do; empty where there is one.
godot::String problem_of_proxy(const godot::Node& node, const godot::NodePath& path);

}  // namespace tactus
