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

// The joint goes along with its bodies; its node need not. As with Godot, moving the node later moves
// nothing, and limits count from where the bodies were first joined, whenever one of them is made anew.
JointDescription JointMirror::in_bodies(const Ends& ends, const JointDescription& joint) {
    const auto id_of = [](const BodyMirror* mirror) { return mirror != nullptr ? mirror->id() : 0; };
    if (ids_[0] != id_of(ends.first) || ids_[1] != id_of(ends.second)) {
        const auto frame_in = [&joint](const BodyMirror* mirror) {
            return mirror == nullptr
                       ? joint.frame
                       : compose(inverse(pose_of(mirror->body()->get_global_transform())), joint.frame);
        };
        ids_[0] = id_of(ends.first);
        ids_[1] = id_of(ends.second);
        frame_in_first_ = frame_in(ends.first);
        frame_in_second_ = frame_in(ends.second);
    }
    JointDescription in_bodies = joint;
    in_bodies.frame = frame_in_first_;
    in_bodies.second_frame = frame_in_second_;
    return in_bodies;
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
    joined_ = in_bodies(ends, reading.joint);
    ++revision_;
    AddResult added = session.add_joint(joined_, first, second);
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
