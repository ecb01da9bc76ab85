// Where the operator is: the fingertips of other operators in the same environment, shown. Main thread only.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/node.hpp>
#include <vector>

#include "session/ghosts.hpp"

namespace tactus {

class GhostView {
public:
    // Pictures are children of `parent`, made when they are needed: first, or since a script has freed them.
    void show(godot::Node& parent, const SeenGhosts& ghosts);

private:
    std::vector<std::uint64_t> pictures_;  // ids
};

}  // namespace tactus
