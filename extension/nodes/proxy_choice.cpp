#include "nodes/proxy_choice.hpp"

#include "nodes/haptic_tool.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/roll.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

template <class NodeType>
const Node3D* first_of_world(const Node& node) {
    for (const NodeType* hand : Roll<NodeType>::all()) {
        if (HapticWorld::above(hand) == HapticWorld::above(&node)) {
            return hand;
        }
    }
    return nullptr;
}

}  // namespace

bool is_hand(const Node* node) {
    return Object::cast_to<ProxyPointer>(node) != nullptr || Object::cast_to<HapticTool>(node) != nullptr;
}

const Node3D* chosen_hand(const Node& node, const NodePath& path) {
    if (!node.is_inside_tree() || !path.is_empty()) {
        const auto* named = node_at<Node3D>(node, path);
        return is_hand(named) ? named : nullptr;
    }
    for (const Node* above = node.get_parent(); above != nullptr; above = above->get_parent()) {
        if (is_hand(above)) {
            return Object::cast_to<Node3D>(above);
        }
    }
    const Node3D* const pointer = first_of_world<ProxyPointer>(node);
    return pointer != nullptr ? pointer : first_of_world<HapticTool>(node);
}

String problem_of_hand(const Node& node, const NodePath& path) {
    if (chosen_hand(node, path) != nullptr) {
        return String();
    }
    return path.is_empty()
               ? String("there is no ProxyPointer or HapticTool in its world: add one")
               : wrong_path("proxy", path, "a ProxyPointer or a HapticTool") + ", or leave it empty";
}

}  // namespace tactus
