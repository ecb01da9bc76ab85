// Where the operator is: the fingertips of other operators in the same environment, shown. Main thread only.
#pragma once

#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/node.hpp>
#include <vector>

#include "session/ghosts.hpp"

namespace tactus {

class GhostView {
public:
    // Pictures are children of `parent`, made when they are needed first.
    void show(godot::Node& parent, const SeenGhosts& ghosts);

private:
    std::vector<godot::MeshInstance3D*> pictures_;
};

}  // namespace tactus
