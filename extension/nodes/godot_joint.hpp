// One of Godot's joints as what mirrors it sees it (world/joint_mirror.hpp). Main thread only.
#pragma once

#include <godot_cpp/classes/joint3d.hpp>

#include "nodes/messages.hpp"
#include "world/joint_mirror.hpp"

namespace tactus {

// What a joint node lacks as it stands in the scene; empty where nothing. `engine_moves`: Godot's own physics
// moves the bodies, and carries out every joint.
std::string problem_of_joint(const godot::Joint3D& node, bool engine_moves);

class GodotJoint final : public SceneJoint {
public:
    GodotJoint(godot::Joint3D& node, bool engine_moves, Complaints& complaints)
        : id_(node.get_instance_id()), node_(node), engine_moves_(engine_moves), complaints_(complaints) {}

    std::uint64_t id() const override { return id_; }
    bool is_there() const override;
    std::string name() const override { return from_godot(name_of(node_)); }
    JointReading read() const override;
    End first() const override { return end_of(node_.get_node_a()); }
    End second() const override { return end_of(node_.get_node_b()); }
    std::string problem() const override;
    void say(const std::string& problem) const override { complaints_.say(node_, problem); }

private:
    End end_of(const godot::NodePath& path) const;

    std::uint64_t id_;
    godot::Joint3D& node_;  // while it is there
    bool engine_moves_;
    Complaints& complaints_;
};

}  // namespace tactus
