// Which device a node follows: the one that its path names, or the nearest one in the scene tree. Main thread
// only.
#pragma once

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/string.hpp>

namespace tactus {

class HapticDevice;

struct DeviceChoice {
    godot::NodePath path;

    HapticDevice* of(const godot::Node& node) const;
    // Why the node has no device of its own world, and what to do; empty where it has one.
    godot::String problem(const godot::Node& node) const;

private:
    HapticDevice* nearest(const godot::Node& node) const;

    mutable std::uint64_t nearest_ = 0;        // id of the nearest device
    mutable std::uint64_t nearest_as_of_ = 0;  // revision of the devices that it was found among
};

}  // namespace tactus
