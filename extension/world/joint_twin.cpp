#include "world/joint_twin.hpp"

#include <algorithm>
#include <utility>

namespace tactus {

bool same_joint(const JointDescription& a, const JointDescription& b) {
    const auto same = [](const JointRange& left, const JointRange& right) {
        return left.lower == right.lower && left.upper == right.upper;
    };
    return a.kind == b.kind && std::ranges::equal(a.linear, b.linear, same) &&
           std::ranges::equal(a.angular, b.angular, same) && a.motor_speed == b.motor_speed &&
           a.motor_torque == b.motor_torque && a.bodies_collide == b.bodies_collide && a.drive == b.drive;
}

// The joint goes along with its bodies; its node need not. As with Godot, moving the node later moves
// nothing, and limits count from where the bodies were first joined, whenever one of them is made anew.
void JointTwin::note_frames(const Pose& frame, const End& first, const End& second) {
    if (sources_[0] == first.source && sources_[1] == second.source) {
        return;
    }
    const auto frame_in = [&frame](const End& end) {
        return end.source == 0 ? frame : compose(inverse(end.pose), frame);
    };
    sources_[0] = first.source;
    sources_[1] = second.source;
    frame_in_first_ = frame_in(first);
    frame_in_second_ = frame_in(second);
}

void JointTwin::synchronise(Session& session, const JointDescription& joint, const End& first,
                            const End& second) {
    if (handle_ != no_handle && first.body == first_ && second.body == second_ && same_joint(joint, asked_)) {
        return;
    }
    remove(session);
    note_frames(joint.frame, first, second);
    asked_ = joint;
    joined_ = joint;
    joined_.frame = frame_in_first_;
    joined_.second_frame = frame_in_second_;
    first_ = first.body;
    second_ = second.body;
    ++revision_;
    AddResult added = session.add_joint(joined_, first_, second_);
    handle_ = added.handle;
    problem_ = std::move(added.error);
}

void JointTwin::remove(Session& session) {
    if (handle_ != no_handle) {
        session.remove_joint(handle_);
        handle_ = no_handle;
    }
    problem_.clear();
}

}  // namespace tactus
