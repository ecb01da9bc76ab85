#include "nodes/device_choice.hpp"

#include "nodes/haptic_device.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

// By the steps from node to node; where two are as near, the one that came first.
HapticDevice* DeviceChoice::nearest(const Node& node) const {
    if (nearest_as_of_ == Roll<HapticDevice>::revision()) {
        return node_of_id<HapticDevice>(nearest_);
    }
    nearest_as_of_ = Roll<HapticDevice>::revision();
    HapticDevice* nearest = nullptr;
    int64_t fewest = INT64_MAX;
    for (HapticDevice* device : Roll<HapticDevice>::all()) {
        const int64_t steps = node.get_path_to(device).get_name_count();
        if (steps < fewest && HapticWorld::above(device) == HapticWorld::above(&node)) {
            nearest = device;
            fewest = steps;
        }
    }
    nearest_ = nearest != nullptr ? nearest->get_instance_id() : 0;
    return nearest;
}

HapticDevice* DeviceChoice::of(const Node& node) const {
    return node.is_inside_tree() && path.is_empty() ? nearest(node) : node_at<HapticDevice>(node, path);
}

String DeviceChoice::problem(const Node& node) const {
    const HapticDevice* device = of(node);
    if (device == nullptr) {
        return path.is_empty()
                   ? String("there is no HapticDevice in its world: add one")
                   : wrong_path("device", path, "a HapticDevice") + ", or leave it empty for the nearest one";
    }
    const auto world_of = [](const Node* one) {
        return is_edited() ? HapticWorld::above(one) : HapticWorld::of(one);
    };
    return world_of(device) == world_of(&node)
               ? String()
               : "its device '" + name_of(*device) +
                     "' belongs to another HapticWorld: choose one of its own world, or put it there";
}

}  // namespace tactus
