// One of Godot's joint nodes and its twin in the session. Main thread only.
#pragma once

#include <functional>
#include <string>

#include "nodes/body_mirror.hpp"
#include "nodes/joint_reading.hpp"
#include "world/joint_twin.hpp"

namespace tactus {

// The mirror of a body of the world; null where the world has none of it.
using FindMirror = std::function<BodyMirror*(const godot::Node*)>;

class JointMirror {
public:
    explicit JointMirror(const godot::Joint3D& node) : id_(node.get_instance_id()) {}

    std::uint64_t id() const { return id_; }
    const godot::Joint3D* node() const;  // null when it is gone
    const JointTwin& twin() const { return twin_; }

    // Joins what there is to join, once both bodies are in the session. Call after the bodies.
    void synchronise(Session& session, const FindMirror& mirror_of);
    void release(Session& session) { twin_.remove(session); }

    // Why it does not join, or only in part; empty where it does.
    const std::string& problem() const { return problem_; }

private:
    std::uint64_t id_;
    JointTwin twin_;
    std::string problem_;
};

// What a joint node lacks as it stands in the scene; empty where nothing.
std::string problem_of_joint(const godot::Joint3D& node);

}  // namespace tactus
