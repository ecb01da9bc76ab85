// Which nodes of a kind are in the running scene tree: how a world finds what belongs to it. Main thread
// only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

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

}  // namespace tactus
