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

// Where the spring of the drive leads to.
double goal_of(const JointDrive& drive, double at) {
    return drive.pitch > 0.0 ? drive.rest + drive.pitch * std::round((at - drive.rest) / drive.pitch)
                             : drive.rest;
}

}  // namespace

JointAxis::JointAxis(const JointDescription& joint, JPH::TwoBodyConstraint& constraint)
    : constraint_(&constraint),
      drive_(joint.drive),
      motor_speed_(joint.motor_speed),
      motor_torque_(joint.motor_torque) {
    if (joint.kind == JointKind::Hinge) {
        kind_ = Kind::hinge;
        range_ = has_limits(joint.angular[2], 2.0 * std::numbers::pi) ? joint.angular[2] : JointRange::free();
        zero_ = has_limits(range_, HUGE_VAL) ? 0.5 * (range_.lower + range_.upper) : 0.0;
    } else if (joint.kind == JointKind::Slider && joint.linear[0].lower != joint.linear[0].upper) {
        kind_ = Kind::slider;
        range_ = joint.linear[0];
    }
}

JPH::HingeConstraint& JointAxis::hinge() const {
    return *static_cast<JPH::HingeConstraint*>(constraint_);
}

JPH::SixDOFConstraint& JointAxis::slider() const {
    return *static_cast<JPH::SixDOFConstraint*>(constraint_);
}

// As ranges count.
double JointAxis::place() const {
    if (kind_ == Kind::hinge) {
        return zero_ + hinge().GetCurrentAngle();
    }
    const JPH::RMat44 first =
        constraint_->GetBody1()->GetCenterOfMassTransform() * constraint_->GetConstraintToBody1Matrix();
    const JPH::RMat44 second =
        constraint_->GetBody2()->GetCenterOfMassTransform() * constraint_->GetConstraintToBody2Matrix();
    const JPH::Vec3 way(second.GetTranslation() - first.GetTranslation());
    return units::meters(first.GetAxisX().Dot(way));
}

void JointAxis::limit(const JointRange& range) const {
    if (kind_ == Kind::hinge) {
        const double half_turn = std::numbers::pi;
        hinge().SetLimits(static_cast<float>(std::clamp(range.lower - zero_, -half_turn, 0.0)),
                          static_cast<float>(std::clamp(range.upper - zero_, 0.0, half_turn)));
        return;
    }
    JPH::Vec3 lower = slider().GetTranslationLimitsMin();
    JPH::Vec3 upper = slider().GetTranslationLimitsMax();
    lower.SetX(units::length(limits::cut(range.lower, limits::farthest)));
    upper.SetX(units::length(limits::cut(range.upper, limits::farthest)));
    slider().SetTranslationLimits(lower, upper);
}

// Velocity and target as ranges count.
void JointAxis::move(JPH::EMotorState state, double velocity, double target) const {
    if (kind_ == Kind::hinge) {
        hinge().SetMotorState(state);
        hinge().SetTargetAngularVelocity(static_cast<float>(velocity));
        hinge().SetTargetAngle(static_cast<float>(target - zero_));
        return;
    }
    slider().SetMotorState(SixAxis::TranslationX, state);
    slider().SetTargetVelocityCS(JPH::Vec3(units::length(velocity), 0.0f, 0.0f));
    slider().SetTargetPositionCS(JPH::Vec3(units::length(target), 0.0f, 0.0f));
}

// A torque scales with the square of Jolt's length, a force with the length, a spring of forces not at all.
void JointAxis::set_motor(double stiffness, double damping, double strongest) const {
    const bool is_hinge = kind_ == Kind::hinge;
    JPH::MotorSettings& motor =
        is_hinge ? hinge().GetMotorSettings() : slider().GetMotorSettings(SixAxis::TranslationX);
    motor.mSpringSettings.mMode = JPH::ESpringMode::StiffnessAndDamping;
    motor.mSpringSettings.mStiffness = is_hinge ? units::area(stiffness) : static_cast<float>(stiffness);
    motor.mSpringSettings.mDamping = is_hinge ? units::area(damping) : static_cast<float>(damping);
    const double most = limits::cut(strongest, limits::strongest);
    if (is_hinge) {
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
    const double at = place();
    const bool is_hinge = kind_ == Kind::hinge;
    const double over = range_.lower <= range_.upper ? beyond(range_, at) : 0.0;
    returns_ = returns_ && std::abs(over) > (is_hinge ? angular_slack : slack);
    if (!returns_) {
        if (range_.lower <= range_.upper) {
            limit(range_);
        }
        act(at);
        return;
    }
    const double most = is_hinge ? return_spin : return_speed;
    limit({std::min(range_.lower, at), std::max(range_.upper, at)});
    set_motor(0.0, 0.0, std::numeric_limits<double>::infinity());
    move(JPH::EMotorState::Velocity, std::clamp(-over / return_time, -most, most), at);
}

}  // namespace tactus
