// Godot's joint nodes as plain descriptions.
//
// Godot's limits of angles count the other way round than ours: how far node A has turned against node B,
// about the joint's axis. Those of lengths count as ours do, B against A.
#pragma once

#include <godot_cpp/classes/joint3d.hpp>
#include <string>

#include "physics/joint.hpp"

namespace tactus {

struct JointReading {
    JointDescription joint;  // its frame is the node's, in the world
    std::string problem;     // what is not carried out and what to do; the rest is, if `usable`
    bool usable = true;
};

JointReading read_joint(const godot::Joint3D& node);

}  // namespace tactus
