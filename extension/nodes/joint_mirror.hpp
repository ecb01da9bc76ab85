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

    // What it joins, and how, for who tells others of it (see Session::add_joint). no_handle: it does not.
    SessionHandle handle() const { return handle_; }
    SessionHandle first() const { return first_; }
    SessionHandle second() const { return second_; }
    const JointDescription& joined() const { return joined_; }
    // Another one whenever it joins anew.
    std::uint64_t revision() const { return revision_; }

private:
    struct Ends {
        BodyMirror* first = nullptr;   // null: the world
        BodyMirror* second = nullptr;  // likewise
        bool complete = false;         // all that is named is there
    };

    Ends find_ends(const godot::Joint3D& node, const FindMirror& mirror_of);
    JointDescription in_bodies(const Ends& ends, const JointDescription& joint);

    std::uint64_t id_;
    SessionHandle handle_ = no_handle;
    SessionHandle first_ = no_handle;
    SessionHandle second_ = no_handle;
    JointDescription sent_;    // as it was read
    JointDescription joined_;  // with frames in those of the bodies
    Pose frame_in_first_, frame_in_second_;
    std::uint64_t ids_[2] = {0, 0};  // of the bodies that these are of; 0: the world
    std::uint64_t revision_ = 0;
    std::string problem_;
};

// What a joint node lacks as it stands in the scene; empty where nothing.
std::string problem_of_joint(const godot::Joint3D& node);

}  // namespace tactus
