#include "nodes/proxy_choice.hpp"

#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/roll.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

const ProxyPointer* chosen_proxy(const Node& node, const NodePath& path) {
    if (!node.is_inside_tree() || !path.is_empty()) {
        return node_at<ProxyPointer>(node, path);
    }
    for (const Node* above = node.get_parent(); above != nullptr; above = above->get_parent()) {
        if (const auto* proxy = Object::cast_to<ProxyPointer>(above)) {
            return proxy;
        }
    }
    for (const ProxyPointer* proxy : Roll<ProxyPointer>::all()) {
        if (HapticWorld::above(proxy) == HapticWorld::above(&node)) {
            return proxy;
        }
    }
    return nullptr;
}

String problem_of_proxy(const Node& node, const NodePath& path) {
    if (chosen_proxy(node, path) != nullptr) {
        return String();
    }
    return path.is_empty() ? String("there is no ProxyPointer in its world: add one")
                           : wrong_path("proxy", path, "a ProxyPointer") + ", or leave it empty";
}

}  // namespace tactus
