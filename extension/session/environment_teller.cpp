#include "session/environment_teller.hpp"

#include <algorithm>

#include "core/math/body_motion.hpp"
#include "network/plausibility.hpp"

namespace tactus {

namespace {

PreparedDiscovery prepared(SessionHandle body, const std::string& name, const BodyAddition& addition,
                           const Pose& frame) {
    ObjectDescription description;
    description.object = body;
    description.name = name;
    description.body = addition.description;
    const BodyMotion motion =
        to_local(frame, BodyMotion{description.body.pose, description.body.linear_velocity,
                                   description.body.angular_velocity});
    description.body.pose = motion.pose;
    description.body.linear_velocity = motion.linear_velocity;
    description.body.angular_velocity = motion.angular_velocity;
    description.touch_shapes = addition.touch_shapes;
    description.touch = addition.touch_material;
    description.detail = addition.detail;
    return prepare_discovery(description);
}

}  // namespace

std::string EnvironmentTeller::tell(SessionHandle body, const std::string& name,
                                    const BodyAddition& addition) {
    if (!prepared(body, name, addition, frame_)) {
        return "\"" + name + "\" cannot be described to the other side: it has more than " +
               std::to_string(max_description_bytes >> 20) + " MiB of shapes, or a value out of range";
    }
    Told& told = told_[body];
    told = {name, addition};
    announce(body, told);
    return {};
}

void EnvironmentTeller::forget(SessionHandle body) {
    if (told_.erase(body) > 0) {
        withdraw(body);
    }
}

void EnvironmentTeller::tell_joint(SessionHandle joint, const JointDescription& description,
                                   SessionHandle first, SessionHandle second) {
    ObjectJoint told{first_joint + joint, first, second, description};
    if (second == no_handle && told.joint.second_frame) {
        told.joint.second_frame = compose(inverse(frame_), *told.joint.second_frame);
    }
    // What is beyond these no motor carries out.
    told.joint.motor_speed =
        std::clamp(told.joint.motor_speed, -plausible::max_angular_speed, plausible::max_angular_speed);
    told.joint.motor_torque = std::min(told.joint.motor_torque, max_motor_torque);
    if (PreparedDiscovery prepared = prepare_discovery(told)) {
        waiting_.push_back(std::move(prepared));
        send_on();
    }
}

void EnvironmentTeller::forget_joint(SessionHandle joint) {
    withdraw(first_joint + joint);
}

void EnvironmentTeller::withdraw(ObjectId object) {
    PreparedDiscovery withdrawn;
    withdrawn.object = object;
    waiting_.push_back(std::move(withdrawn));
    send_on();
}

void EnvironmentTeller::update(const SessionSnapshot& snapshot, std::uint64_t peer_epoch) {
    if (peer_epoch != peer_epoch_) {
        peer_epoch_ = peer_epoch;
        for (std::size_t i = 0; i < snapshot.body_count; ++i) {
            const BodyState& state = snapshot.bodies[i];
            if (const auto found = told_.find(state.handle); found != told_.end()) {
                BodyDescription& description = found->second.addition.description;
                description.pose = state.pose;
                description.linear_velocity = state.linear_velocity;
                description.angular_velocity = state.angular_velocity;
                announce(state.handle, found->second);
            }
        }
    }
    std::shared_ptr<const std::vector<std::byte>> content;
    while (port_->released.try_pop(content)) {
        content.reset();
    }
    send_on();
}

void EnvironmentTeller::announce(SessionHandle body, const Told& told) {
    waiting_.push_back(prepared(body, told.name, told.addition, frame_));
    send_on();
}

// The loop takes what is announced before what is withdrawn: nothing is announced while it has a withdrawal
// still to take, which might be of the same body.
void EnvironmentTeller::send_on() {
    while (!waiting_.empty()) {
        PreparedDiscovery& next = waiting_.front();
        const bool withdrawal = !next;
        if (!withdrawal && port_->withdrawn.size() > 0) {
            return;
        }
        const PreparedDiscovery told = next;
        if (withdrawal ? !port_->withdrawn.try_push(next.object)
                       : !port_->announced.try_push(std::move(next))) {
            return;
        }
        if (!withdrawal && port_->tap) {
            port_->tap->announced(told);
        }
        waiting_.pop_front();
    }
}

}  // namespace tactus
