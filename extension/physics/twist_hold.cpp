#include "physics/twist_hold.hpp"

#include <algorithm>

#include "physics/jolt_units.hpp"
#include "physics/limits.hpp"

namespace tactus {

void TwistHold::set(const JPH::Body& body, const TwistSpring& twist) {
    *this = {};
    axis_ = units::plain(twist.axis);
    start_ = body.GetRotation();
    twist_ = static_cast<float>(twist.twist);
    stiffness_ = units::area(limits::cut(twist.stiffness, limits::stiffest));
    limit_ = stiffness_ > 0.0f ? units::area(limits::cut(twist.limit, limits::strongest)) : 0.0f;
    patch_spin_ = static_cast<float>(limits::cut(twist.patch_spin, limits::fastest_spin));
}

void TwistHold::set_up(const JPH::Body& body, float seconds) {
    if (!holds())
        return;
    turn_ = body.GetMotionProperties()->MultiplyWorldSpaceInverseInertiaByVector(body.GetRotation(), axis_);
    // Of the turn in the sub-steps before, which is small, twice the sine of half the angle.
    const JPH::Quat turned = (body.GetRotation() * start_.Conjugated()).EnsureWPositive();
    const float twist = twist_ + 2.0f * turned.GetXYZ().Dot(axis_) - patch_spin_ * elapsed_;
    elapsed_ += seconds;
    softness_ = 1.0f / (stiffness_ * seconds * seconds);
    bias_ = patch_spin_ - twist / seconds;
    effective_inertia_ = 1.0f / (axis_.Dot(turn_) + softness_);
    max_impulse_ = limit_ * seconds;
    impulse_ = std::clamp(-stiffness_ * twist * seconds, -max_impulse_, max_impulse_);
}

bool TwistHold::solve(JPH::Body& body) {
    if (!holds())
        return false;
    const float spin = axis_.Dot(body.GetMotionProperties()->GetAngularVelocity());
    const float before = impulse_;
    impulse_ = std::clamp(before - effective_inertia_ * (spin + softness_ * before - bias_), -max_impulse_,
                          max_impulse_);
    add_impulse(body, impulse_ - before);
    return impulse_ != before;
}

void TwistHold::add_impulse(JPH::Body& body, float impulse) {
    if (holds())
        body.GetMotionProperties()->AddAngularVelocityStep(impulse * turn_);
}

}  // namespace tactus
