#include "nodes/joint_mirror.hpp"

#include <utility>

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

struct Ends {
    JointTwin::End first, second;
    bool complete = false;  // all that is named is there
};

// As Godot does it: where one end alone is a body, it is the first.
Ends find_ends(const Joint3D& node, const FindMirror& mirror_of) {
    Ends ends;
    const auto find = [&](const NodePath& path, JointTwin::End& end) {
        const BodyMirror* mirror = path.is_empty() ? nullptr : mirror_of(node.get_node_or_null(path));
        if (mirror != nullptr && mirror->handle() != no_handle) {
            end = {mirror->id(), mirror->handle(), pose_of(mirror->body()->get_global_transform())};
        }
        return path.is_empty() || end.source != 0;
    };
    ends.complete = find(node.get_node_a(), ends.first) & find(node.get_node_b(), ends.second);
    if (ends.first.source == 0) {
        std::swap(ends.first, ends.second);
    }
    ends.complete = ends.complete && ends.first.source != 0;
    return ends;
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
    twin_.synchronise(session, reading.joint, ends.first, ends.second);
    problem_ = twin_.problem().empty() ? reading.problem : twin_.problem();
}

}  // namespace tactus
