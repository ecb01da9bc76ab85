#include "world/joint_mirror.hpp"

#include <utility>

namespace tactus {

namespace {

// The world where nothing is named; none at all where what is named is not in the session.
std::optional<JointTwin::End> end_of(const SceneJoint::End& named, const JointMirror::FindMirror& mirror_of) {
    if (!named.is_named) {
        return JointTwin::End{};
    }
    const BodyMirror* mirror = named.body != 0 ? mirror_of(named.body) : nullptr;
    if (mirror == nullptr || mirror->handle() == no_handle || mirror->body() == nullptr) {
        return std::nullopt;
    }
    return JointTwin::End{mirror->id(), mirror->handle(), pose_of(mirror->body()->frame())};
}

}  // namespace

void JointMirror::synchronise(Session& session, const FindMirror& mirror_of) {
    if (!joint_->is_there()) {
        return;
    }
    const JointReading reading = joint_->read();
    std::optional<JointTwin::End> first = end_of(joint_->first(), mirror_of);
    std::optional<JointTwin::End> second = end_of(joint_->second(), mirror_of);
    // As Godot does it: where one end alone is a body, it is the first.
    if (first && first->source == 0) {
        std::swap(first, second);
    }
    if (!reading.usable || !first || !second || first->source == 0) {
        release(session);
    } else {
        twin_.synchronise(session, reading.joint, *first, *second);
    }
    // A game that empties a joint, or frees what it held, makes no mistake: after it has joined once.
    const bool is_as_begun = twin_.revision() == 0 || (twin_.revision() == 1 && twin_.handle() != no_handle);
    problem_ = !twin_.problem().empty()   ? twin_.problem()
               : !reading.problem.empty() ? reading.problem
               : is_as_begun              ? joint_->problem()
                                          : std::string();
    joint_->say(problem_);
}

}  // namespace tactus
