#include "physics/joint_axis.hpp"

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Constraints/HingeConstraint.h>
#include <Jolt/Physics/Constraints/SixDOFConstraint.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/jolt_units.hpp"
#include "physics/limits.hpp"

namespace tactus {

namespace {

using SixAxis = JPH::SixDOFConstraintSettings::EAxis;

// Back to a limit that was moved: on a spring of 1000 N/m under a finger by 0.1 N a tick.
constexpr double return_speed = 0.1;    // (unit: meters per second)
constexpr double return_spin = 1.0;     // (unit: radians per second)
constexpr double return_time = 0.01;    // in which the rest of the way is gone (unit: seconds)
constexpr double slack = 1e-5;          // beyond a limit, that Jolt itself corrects (unit: meters)
constexpr double angular_slack = 1e-4;  // (unit: radians)

bool has_limits(const JointRange& range, double full) {
    return range.lower <= range.upper && range.upper - range.lower < full;
}

double beyond(const JointRange& range, double at) {
    return at < range.lower ? at - range.lower : at > range.upper ? at - range.upper : 0.0;
}

// Of six axes, those along come first.
JPH::Vec3 with_part(JPH::Vec3 whole, int index, float part) {
    whole.SetComponent(static_cast<JPH::uint>(index % 3), part);
    return whole;
}

// Where the spring of the drive leads to.
double goal_of(const JointDrive& drive, double at) {
    return drive.pitch > 0.0 ? drive.rest + drive.pitch * std::round((at - drive.rest) / drive.pitch)
                             : drive.rest;
}

}  // namespace

JointAxis::JointAxis(const JointDescription& joint, JPH::TwoBodyConstraint& constraint, int index)
    : index_(index), constraint_(&constraint) {
    const JointRange& along = joint.linear[static_cast<std::size_t>(index % 3)];
    const JointRange& about = joint.angular[static_cast<std::size_t>(index % 3)];
    const double whole_turn = 2.0 * std::numbers::pi;
    if (joint.kind == JointKind::Hinge && index == 0) {
        kind_ = Kind::hinge;
        range_ = has_limits(joint.angular[2], whole_turn) ? joint.angular[2] : JointRange::free();
        zero_ = has_limits(range_, HUGE_VAL) ? 0.5 * (range_.lower + range_.upper) : 0.0;
        drive_ = joint.drive;
        motor_speed_ = joint.motor_speed;
        motor_torque_ = joint.motor_torque;
    } else if (joint.kind == JointKind::Slider && index == 0) {
        kind_ = Kind::along;
        range_ = along;
        drive_ = along.lower == along.upper ? JointDrive{} : joint.drive;
    } else if (joint.kind == JointKind::SixAxes &&
               has_limits(index < 3 ? along : about, index < 3 ? HUGE_VAL : whole_turn)) {
        kind_ = index < 3 ? Kind::along : Kind::about;
        range_ = index < 3 ? along : about;
    }
    limits_ = range_;
}

JPH::HingeConstraint& JointAxis::hinge() const {
    return *static_cast<JPH::HingeConstraint*>(constraint_);
}

JPH::SixDOFConstraint& JointAxis::six() const {
    return *static_cast<JPH::SixDOFConstraint*>(constraint_);
}

bool JointAxis::is_driven() const {
    return motor_torque_ > 0.0 || drive_.stiffness > 0.0 || drive_.damping > 0.0;
}

// As ranges count.
double JointAxis::place() const {
    if (kind_ == Kind::hinge) {
        return zero_ + hinge().GetCurrentAngle();
    }
    if (kind_ == Kind::about) {
        JPH::Quat swing, twist;
        six().GetRotationInConstraintSpace().GetSwingTwist(swing, twist);
        const JPH::Quat& part = index_ == SixAxis::RotationX ? twist : swing;
        const double sine = part.GetXYZ()[static_cast<JPH::uint>(index_ - SixAxis::RotationX)];
        return std::remainder(2.0 * std::atan2(sine, part.GetW()), 2.0 * std::numbers::pi);
    }
    const JPH::RMat44 first =
        constraint_->GetBody1()->GetCenterOfMassTransform() * constraint_->GetConstraintToBody1Matrix();
    const JPH::RMat44 second =
        constraint_->GetBody2()->GetCenterOfMassTransform() * constraint_->GetConstraintToBody2Matrix();
    const JPH::Vec3 way(second.GetTranslation() - first.GetTranslation());
    return units::meters(first.GetColumn3(static_cast<JPH::uint>(index_)).Dot(way));
}

void JointAxis::limit(const JointRange& range) {
    if (range.lower > range.upper || (range.lower == limits_.lower && range.upper == limits_.upper)) {
        return;
    }
    limits_ = range;
    if (kind_ == Kind::hinge) {
        const double half_turn = std::numbers::pi;
        hinge().SetLimits(static_cast<float>(std::clamp(range.lower - zero_, -half_turn, 0.0)),
                          static_cast<float>(std::clamp(range.upper - zero_, 0.0, half_turn)));
        return;
    }
    if (kind_ == Kind::about) {
        six().SetRotationLimits(
            with_part(six().GetRotationLimitsMin(), index_, static_cast<float>(range.lower)),
            with_part(six().GetRotationLimitsMax(), index_, static_cast<float>(range.upper)));
        return;
    }
    six().SetTranslationLimits(with_part(six().GetTranslationLimitsMin(), index_,
                                         units::length(limits::cut(range.lower, limits::farthest))),
                               with_part(six().GetTranslationLimitsMax(), index_,
                                         units::length(limits::cut(range.upper, limits::farthest))));
}

// Velocity and target as ranges count.
void JointAxis::move(JPH::EMotorState state, double velocity, double target) const {
    if (kind_ == Kind::hinge) {
        hinge().SetMotorState(state);
        hinge().SetTargetAngularVelocity(static_cast<float>(velocity));
        hinge().SetTargetAngle(static_cast<float>(target - zero_));
        return;
    }
    six().SetMotorState(static_cast<SixAxis>(index_), state);
    if (kind_ == Kind::about) {
        six().SetTargetAngularVelocityCS(
            with_part(six().GetTargetAngularVelocityCS(), index_, static_cast<float>(velocity)));
        return;
    }
    six().SetTargetVelocityCS(with_part(six().GetTargetVelocityCS(), index_, units::length(velocity)));
    six().SetTargetPositionCS(with_part(six().GetTargetPositionCS(), index_, units::length(target)));
}

// A torque scales with the square of Jolt's length, a force with the length, a spring of forces not at all.
void JointAxis::set_motor(double stiffness, double damping, double strongest) const {
    JPH::MotorSettings& motor = kind_ == Kind::hinge ? hinge().GetMotorSettings()
                                                     : six().GetMotorSettings(static_cast<SixAxis>(index_));
    motor.mSpringSettings.mMode = JPH::ESpringMode::StiffnessAndDamping;
    motor.mSpringSettings.mStiffness = turns() ? units::area(stiffness) : static_cast<float>(stiffness);
    motor.mSpringSettings.mDamping = turns() ? units::area(damping) : static_cast<float>(damping);
    const double most = limits::cut(strongest, limits::strongest);
    if (turns()) {
        motor.SetTorqueLimit(units::area(most));
    } else {
        motor.SetForceLimit(units::length(most));
    }
}

void JointAxis::act(double at) const {
    if (motor_torque_ > 0.0) {
        set_motor(0.0, 0.0, motor_torque_);
        move(JPH::EMotorState::Velocity, limits::cut(motor_speed_, limits::fastest_spin), at);
        return;
    }
    const double goal = goal_of(drive_, at);
    const bool is_led =
        drive_.stiffness > 0.0 && (drive_.reach <= 0.0 || std::abs(at - goal) <= drive_.reach);
    if (!is_led && drive_.damping <= 0.0) {
        move(JPH::EMotorState::Off, 0.0, at);
        return;
    }
    const double strongest =
        is_led && drive_.strength > 0.0 ? drive_.strength : std::numeric_limits<double>::infinity();
    set_motor(is_led ? drive_.stiffness : 0.0, drive_.damping, strongest);
    move(JPH::EMotorState::PositionAndVelocity, 0.0, goal);
}

void JointAxis::drive() {
    if (kind_ == Kind::none ||
        (!constraint_->GetBody1()->IsActive() && !constraint_->GetBody2()->IsActive())) {
        return;
    }
    if (!returns_ && !is_driven()) {
        limit(range_);
        return;
    }
    const double at = place();
    const double over = range_.lower <= range_.upper ? beyond(range_, at) : 0.0;
    returns_ = returns_ && std::abs(over) > (turns() ? angular_slack : slack);
    if (!returns_) {
        limit(range_);
        act(at);
        return;
    }
    const double most = turns() ? return_spin : return_speed;
    limit({std::min(range_.lower, at), std::max(range_.upper, at)});
    set_motor(0.0, 0.0, std::numeric_limits<double>::infinity());
    move(JPH::EMotorState::Velocity, std::clamp(-over / return_time, -most, most), at);
}

}  // namespace tactus
