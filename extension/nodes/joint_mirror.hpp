// One of Godot's joint nodes and its twin in the session. Main thread only.
#pragma once

#include <functional>
#include <string>

#include "nodes/body_mirror.hpp"
#include "nodes/joint_reading.hpp"

namespace tactus {

// The mirror of a body of the world; null where the world has none of it.
using FindMirror = std::function<BodyMirror*(const godot::Node*)>;

class JointMirror {
public:
    explicit JointMirror(const godot::Joint3D& node) : id_(node.get_instance_id()) {}

    std::uint64_t id() const { return id_; }
    const godot::Joint3D* node() const;  // null when it is gone

    // Joins what there is to join, once both bodies are in the session; anew when the joint or one of the
    // bodies' twins has changed. Call after the bodies.
    void synchronise(Session& session, const FindMirror& mirror_of);
    void release(Session& session);

    // Why it does not join, or only in part; empty where it does.
    const std::string& problem() const { return problem_; }

private:
    struct Ends {
        BodyMirror* first = nullptr;   // null: the world
        BodyMirror* second = nullptr;  // likewise
        bool complete = false;         // all that is named is there
    };

    Ends find_ends(const godot::Joint3D& node, const FindMirror& mirror_of);
    Pose frame_in(const BodyMirror& anchor, const JointDescription& joint);

    std::uint64_t id_;
    SessionHandle handle_ = no_handle;
    SessionHandle first_ = no_handle;
    SessionHandle second_ = no_handle;
    JointDescription sent_;
    Pose frame_in_anchor_;      // of the joint, in the frame of the first of its bodies
    std::uint64_t anchor_ = 0;  // id of that body
    std::string problem_;
};

// What a joint node lacks as it stands in the scene; empty where nothing.
std::string problem_of_joint(const godot::Joint3D& node);

}  // namespace tactus
