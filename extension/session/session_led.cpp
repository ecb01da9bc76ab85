// Bodies that another physics moves, and that this one predicts (Session::lead_body): what hands give them is
// summed up, and corrections are carried out so that no hand is kicked.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_spring.hpp"
#include "core/math/body_motion.hpp"
#include "session/session_loop.hpp"

namespace tactus {

SessionLoop::Led* SessionLoop::led(SessionHandle handle) {
    const auto found =
        std::ranges::find_if(led_, [handle](const Led& one) { return one.state.handle == handle; });
    return found != led_.end() ? &*found : nullptr;
}

bool SessionLoop::carry_out(command::LeadBody& c, Retired&) {
    if (!c.led) {
        if (std::erase_if(led_, [&c](const Led& one) { return one.state.handle == c.handle; }) > 0) {
            set_factors(c.handle, {});
        }
    } else if (body(c.handle) && !led(c.handle) && led_.size() < max_led) {
        led_.push_back({});
        led_.back().state.handle = c.handle;
        led_.back().state.motion = motion(c.handle);
    }
    return false;
}

bool SessionLoop::carry_out(command::CorrectBody& c, Retired&) {
    Led* const one = led(c.handle);
    if (!one) {
        return false;
    }
    const BodyCorrection& correction = c.correction;
    one->left.by += correction.by;
    one->left.turn += correction.turn;
    one->left.seconds = correction.seconds;
    one->left.acceleration = correction.acceleration;
    one->left.spin_up = correction.spin_up;
    one->state.corrected.linear += correction.linear;
    one->state.corrected.angular += correction.angular;
    if (correction.linear != Vec3(0.0) || correction.angular != Vec3(0.0)) {
        const BodyMotion now = motion(c.handle);
        physics_.set_velocity(bodies_[c.handle].id, now.linear_velocity + correction.linear,
                              now.angular_velocity + correction.angular);
    }
    one->state.corrected.mass = correction.mass;
    set_factors(c.handle, {.mass = correction.mass});
    if (correction.seconds == 0.0) {
        put_right_at_once(*one);
    }
    return false;
}

void SessionLoop::put_right_at_once(Led& one) {
    const SessionHandle handle = one.state.handle;
    const Vec3 by = std::exchange(one.left.by, Vec3(0.0));
    const Vec3 turn = std::exchange(one.left.turn, Vec3(0.0));
    const Pose pose = shifted(physics_.pose(bodies_[handle].id), by, turn_by(turn, 1.0));
    physics_.set_pose(bodies_[handle].id, pose);
    place(handle, pose, true);
    one.state.corrected.by += by;
    one.state.corrected.turn += turn;
    fade_in(handle);
}

void SessionLoop::fade_in(SessionHandle handle) {
    for (ProxySlot& slot : proxies_) {
        slot.changed = slot.changed || (slot.proxy && rests_on(*slot.proxy, handle));
    }
}

// Of a way that moves its surface by so much in this tick (unit: meters), the share that changes the force of
// a hand on it by no more than any change of the scene may.
double SessionLoop::smoothest_share(SessionHandle handle, double way) const {
    if (!is_touched(handle)) {
        return 1.0;
    }
    const double stiffness = spring_of(scene_.body(bodies_[handle].slot).material).steepest();
    const double change = stiffness * way;
    return change > FadingForce::max_step ? FadingForce::max_step / change : 1.0;
}

void SessionLoop::go_on(Led& one) {
    constexpr double rounding = 1e-9;  // (units: meters, radians)
    BodyCorrection& left = one.left;
    const double ticks = std::max(1.0, std::round(left.seconds / seconds_));
    const SessionHandle handle = one.state.handle;
    const Body& moved = bodies_[handle];
    if (glm::length(left.by) + glm::length(left.turn) > rounding) {
        const double way = (glm::length(left.by) + moved.shape->reach * glm::length(left.turn)) / ticks;
        const double share = smoothest_share(handle, way) / ticks;
        const Vec3 by = left.by * share;
        const Vec3 turn = left.turn * share;
        const Pose pose = shifted(physics_.pose(moved.id), by, turn_by(turn, 1.0));
        physics_.set_pose(moved.id, pose);
        place(handle, pose, false);
        left.by -= by;
        left.turn -= turn;
        one.state.corrected.by += by;
        one.state.corrected.turn += turn;
    }
    left.seconds = std::max(0.0, left.seconds - seconds_);
    if (left.acceleration != Vec3(0.0) || left.spin_up != Vec3(0.0)) {
        const BodyMotion now = motion(handle);
        physics_.set_velocity(moved.id, now.linear_velocity + left.acceleration * seconds_,
                              now.angular_velocity + left.spin_up * seconds_);
    }
}

void SessionLoop::put_led_right() {
    for (Led& one : led_) {
        if (bodies_[one.state.handle].motion == Motion::Dynamic) {
            go_on(one);
        }
    }
}

void SessionLoop::note_led() {
    if (led_.empty()) {
        return;
    }
    for (const HandPush& push : physics_.hand_pushes()) {
        if (Led* const one = led(handle_of_id_[push.body.index()])) {
            one->state.impulse += push.impulse;
            one->state.turn += push.turn;
            one->state.spun += physics_.spun_by(push.body, push.turn);
        }
    }
    for (Led& one : led_) {
        one.state.motion = motion(one.state.handle);
        one.state.way += one.state.motion.linear_velocity * seconds_;
        one.state.turned += one.state.motion.angular_velocity * seconds_;
        one.state.seconds += seconds_;
        one.state.mass = physics_.mass(bodies_[one.state.handle].id);
    }
}

}  // namespace tactus
