// Which nodes of a kind are in the scene tree: how a world finds what belongs to it. Main thread only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "nodes/scene_warnings.hpp"

namespace tactus {

template <typename NodeType>
class Roll {
public:
    static const std::vector<NodeType*>& all() { return nodes(); }
    static void enter(NodeType* node) {
        nodes().push_back(node);
        ++changes();
    }
    static void leave(NodeType* node) {
        std::erase(nodes(), node);
        ++changes();
    }
    // Another one whenever a node has come or gone.
    static std::uint64_t revision() { return changes(); }

private:
    static std::uint64_t& changes() {
        static std::uint64_t count = 1;
        return count;
    }
    static std::vector<NodeType*>& nodes() {
        static std::vector<NodeType*> living;
        return living;
    }
};

// What each of our nodes does first with what it is notified of.
template <typename NodeType>
void keep_roll(NodeType& node, int what) {
    if (what == NodeType::NOTIFICATION_ENTER_TREE) {
        Roll<NodeType>::enter(&node);
        watch_warnings(node);
    } else if (what == NodeType::NOTIFICATION_EXIT_TREE) {
        Roll<NodeType>::leave(&node);
    }
}

}  // namespace tactus
