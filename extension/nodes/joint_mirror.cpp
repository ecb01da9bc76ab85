#include "nodes/joint_mirror.hpp"

#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

namespace {

// Empty where the path is, or leads to a body.
std::string problem_of_end(const Joint3D& node, const NodePath& path, const char* property) {
    if (path.is_empty() || is_solid_body(node.get_node_or_null(path))) {
        return {};
    }
    return std::string("its ") + property + " '" + from_godot(String(path)) +
           "' is not a body of the scene: set it anew, or leave it empty for the world";
}

}  // namespace

std::string problem_of_joint(const Joint3D& node) {
    const JointReading reading = read_joint(node);
    if (!reading.problem.empty()) {
        return reading.problem;
    }
    if (node.get_node_a().is_empty() && node.get_node_b().is_empty()) {
        return "it joins nothing: set node_a, node_b or both";
    }
    std::string problem = problem_of_end(node, node.get_node_a(), "node_a");
    return problem.empty() ? problem_of_end(node, node.get_node_b(), "node_b") : problem;
}

const Joint3D* JointMirror::node() const {
    return Object::cast_to<Joint3D>(ObjectDB::get_instance(id_));
}

// As Godot does it: where one end alone is a body, it is the first.
JointMirror::Ends JointMirror::find_ends(const Joint3D& node, const FindMirror& mirror_of) {
    Ends ends;
    const auto find = [&](const NodePath& path) {
        return path.is_empty() ? nullptr : mirror_of(node.get_node_or_null(path));
    };
    ends.first = find(node.get_node_a());
    ends.second = find(node.get_node_b());
    const auto is_ready = [](const NodePath& path, const BodyMirror* mirror) {
        return path.is_empty() || (mirror != nullptr && mirror->handle() != no_handle);
    };
    ends.complete = is_ready(node.get_node_a(), ends.first) && is_ready(node.get_node_b(), ends.second) &&
                    (ends.first != nullptr || ends.second != nullptr);
    if (ends.first == nullptr) {
        std::swap(ends.first, ends.second);
    }
    return ends;
}

// The joint goes along with the body; its node need not. As with Godot, moving the node later moves nothing.
Pose JointMirror::frame_in(const BodyMirror& anchor, const JointDescription& joint) {
    if (anchor_ != anchor.id()) {
        const Pose body = pose_of(anchor.body()->get_global_transform());
        anchor_ = anchor.id();
        frame_in_anchor_ = {to_local(body, joint.frame.position),
                            glm::conjugate(body.rotation) * joint.frame.rotation};
    }
    return frame_in_anchor_;
}

void JointMirror::synchronise(Session& session, const FindMirror& mirror_of) {
    const Joint3D* joint_node = node();
    if (joint_node == nullptr) {
        return;
    }
    const JointReading reading = read_joint(*joint_node);
    const Ends ends = find_ends(*joint_node, mirror_of);
    if (!reading.usable || !ends.complete) {
        release(session);
        problem_ = problem_of_joint(*joint_node);
        return;
    }
    problem_ = reading.problem;
    const SessionHandle first = ends.first->handle();
    const SessionHandle second = ends.second != nullptr ? ends.second->handle() : no_handle;
    if (handle_ != no_handle && first == first_ && second == second_ && same_joint(reading.joint, sent_)) {
        return;
    }
    release(session);
    JointDescription joint = reading.joint;
    joint.frame = frame_in(*ends.first, reading.joint);
    AddResult added = session.add_joint(joint, first, second);
    handle_ = added.handle;
    problem_ = added.error.empty() ? problem_ : std::move(added.error);
    first_ = first;
    second_ = second;
    sent_ = reading.joint;
}

void JointMirror::release(Session& session) {
    if (handle_ != no_handle) {
        session.remove_joint(handle_);
        handle_ = no_handle;
    }
}

}  // namespace tactus
