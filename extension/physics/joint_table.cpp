#include "physics/joint_table.hpp"

#include "physics/jolt.hpp"

#include <Jolt/Physics/Constraints/HingeConstraint.h>
#include <Jolt/Physics/Constraints/PointConstraint.h>
#include <Jolt/Physics/Constraints/SixDOFConstraint.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/Physics/StateRecorder.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/jolt_units.hpp"
#include "physics/limits.hpp"

namespace tactus {

namespace {

constexpr std::uint32_t index_bits = 16;
constexpr std::uint32_t index_mask = (1u << index_bits) - 1;

bool holds_point(const JointDescription& joint) {
    return joint.kind == JointKind::Pin || joint.kind == JointKind::Hinge ||
           (joint.kind == JointKind::SixAxes && std::ranges::all_of(joint.linear, &JointRange::is_locked));
}

JPH::Vec3 axis(const Pose& frame, const Vec3& in_frame) {
    return units::plain(frame.rotation * in_frame);
}

const Pose& second_frame(const JointDescription& joint) {
    return joint.second_frame ? *joint.second_frame : joint.frame;
}

JPH::TwoBodyConstraint* pin(const JointDescription& joint, JPH::Body& first, JPH::Body& second) {
    const JPH::Ref settings = new JPH::PointConstraintSettings;
    settings->mPoint1 = units::position(joint.frame.position);
    settings->mPoint2 = units::position(second_frame(joint).position);
    return settings->Create(first, second);
}

// Jolt's limits enclose its zero, ours need not: its zero is put into the middle of the range.
JPH::TwoBodyConstraint* hinge(const JointDescription& joint, JPH::Body& first, JPH::Body& second) {
    const JointRange& range = joint.angular[2];
    const bool free = range.is_free() || range.upper - range.lower >= 2.0 * std::numbers::pi;
    const double middle = free ? 0.0 : 0.5 * (range.lower + range.upper);
    const double half = free ? std::numbers::pi : 0.5 * (range.upper - range.lower);
    const JPH::Ref settings = new JPH::HingeConstraintSettings;
    settings->mPoint1 = units::position(joint.frame.position);
    settings->mPoint2 = units::position(second_frame(joint).position);
    settings->mHingeAxis1 = axis(joint.frame, {0.0, 0.0, 1.0});
    settings->mHingeAxis2 = axis(second_frame(joint), {0.0, 0.0, 1.0});
    settings->mNormalAxis1 = axis(joint.frame, {std::cos(middle), std::sin(middle), 0.0});
    settings->mNormalAxis2 = axis(second_frame(joint), {1.0, 0.0, 0.0});
    settings->mLimitsMin = static_cast<float>(-half);
    settings->mLimitsMax = static_cast<float>(half);
    if (joint.motor_torque > 0.0)
        settings->mMotorSettings.SetTorqueLimit(
            units::area(limits::cut(joint.motor_torque, limits::strongest)));
    auto* constraint = static_cast<JPH::HingeConstraint*>(settings->Create(first, second));
    if (joint.motor_torque > 0.0) {
        constraint->SetTargetAngularVelocity(
            static_cast<float>(limits::cut(joint.motor_speed, limits::fastest_spin)));
        constraint->SetMotorState(JPH::EMotorState::Velocity);
    }
    return constraint;
}

JPH::TwoBodyConstraint* six_axes(const JointDescription& joint, JPH::Body& first, JPH::Body& second) {
    using Axis = JPH::SixDOFConstraintSettings::EAxis;
    const JPH::Ref settings = new JPH::SixDOFConstraintSettings;
    settings->mPosition1 = units::position(joint.frame.position);
    settings->mPosition2 = units::position(second_frame(joint).position);
    settings->mAxisX1 = axis(joint.frame, {1.0, 0.0, 0.0});
    settings->mAxisX2 = axis(second_frame(joint), {1.0, 0.0, 0.0});
    settings->mAxisY1 = axis(joint.frame, {0.0, 1.0, 0.0});
    settings->mAxisY2 = axis(second_frame(joint), {0.0, 1.0, 0.0});
    settings->mSwingType = JPH::ESwingType::Pyramid;
    const auto limit = [&settings](int index, const JointRange& range, double to_jolt, double full) {
        const auto which = static_cast<Axis>(index);
        if (range.is_free() || range.upper - range.lower >= full)
            settings->MakeFreeAxis(which);
        else if (range.is_locked())
            settings->MakeFixedAxis(which);
        else
            settings->SetLimitedAxis(
                which, static_cast<float>(limits::cut(range.lower, limits::farthest) * to_jolt),
                static_cast<float>(limits::cut(range.upper, limits::farthest) * to_jolt));
    };
    const bool slider = joint.kind == JointKind::Slider;
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        limit(i, slider && i > 0 ? JointRange::locked() : joint.linear[at], units::jolt_per_meter, HUGE_VAL);
        limit(3 + i, slider ? JointRange::locked() : joint.angular[at], 1.0, 2.0 * std::numbers::pi);
    }
    return settings->Create(first, second);
}

JPH::TwoBodyConstraint* create(const JointDescription& joint, JPH::Body& first, JPH::Body& second) {
    switch (joint.kind) {
        case JointKind::Pin:
            return pin(joint, first, second);
        case JointKind::Hinge:
            return hinge(joint, first, second);
        case JointKind::Slider:
        case JointKind::SixAxes:
            return six_axes(joint, first, second);
    }
    return nullptr;
}

}  // namespace

std::string wrong_in(const JointDescription& joint) {
    if (!limits::is_pose(joint.frame) || !limits::is_pose(second_frame(joint)))
        return "the joint's transform is not finite, holds a scale or is more than 10,000 km away; reset it";
    for (const auto& ranges : {joint.linear, joint.angular})
        for (const JointRange& range : ranges)
            if (!std::isfinite(range.lower + range.upper))
                return "a limit of the joint is not a finite number";
    for (const JointRange& range : joint.angular)
        if (!range.is_free() && (range.lower < -std::numbers::pi || range.upper > std::numbers::pi))
            return "an angle limit of the joint is beyond half a turn; keep within -180 to 180 degrees";
    if (!std::isfinite(joint.motor_speed) ||
        !(joint.motor_torque >= 0.0 && std::isfinite(joint.motor_torque)))
        return "the joint's motor needs a finite speed and a torque that is not negative";
    const JointDrive& drive = joint.drive;
    for (const double value : {drive.stiffness, drive.damping, drive.pitch, drive.strength, drive.reach})
        if (!(value >= 0.0 && value <= limits::stiffest))
            return "a value of the joint's drive is negative, above 10^9 or not a number: set it anew";
    if (!(std::abs(drive.rest) <= limits::farthest))
        return "the joint's drive rests nowhere: set 'rest' to a finite number";
    const bool is_driven = drive.stiffness > 0.0 || drive.damping > 0.0;
    if (is_driven && joint.kind != JointKind::Hinge && joint.kind != JointKind::Slider)
        return "only a hinge or a slider that does not turn can have a drive: use one of them";
    return {};
}

JointTable::JointTable(JPH::PhysicsSystem& system, std::size_t most) : system_(system), joints_(most) {
    SetEmbedded();  // lives in the world, Jolt does not delete it
}

JointId JointTable::add(const JointDescription& description, JPH::Body& first, JPH::Body& second,
                        const Pose& first_pose, const Pose& second_pose) {
    const auto vacant = std::find_if(joints_.begin(), joints_.end(),
                                     [](const Joint& joint) { return joint.constraint == nullptr; });
    if (vacant == joints_.end())
        return {};
    vacant->constraint = create(description, first, second);
    vacant->first = first.GetID().GetIndexAndSequenceNumber();
    vacant->second = second.GetID().GetIndexAndSequenceNumber();
    vacant->bodies_collide = description.bodies_collide;
    vacant->holds_point = holds_point(description);
    for (std::size_t i = 0; i < vacant->axes.size(); ++i)
        vacant->axes[i] = JointAxis(description, *vacant->constraint, static_cast<int>(i));
    vacant->described = description;
    vacant->described.frame = compose(inverse(first_pose), description.frame);
    vacant->described.second_frame = compose(inverse(second_pose), second_frame(description));
    join_group(first);
    join_group(second);
    system_.AddConstraint(vacant->constraint);
    ++count_;
    return {(vacant->generation << index_bits) | static_cast<std::uint32_t>(vacant - joints_.begin())};
}

bool JointTable::remove(JointId id) {
    const std::size_t index = id.value & index_mask;
    if (index >= joints_.size() || joints_[index].constraint == nullptr ||
        joints_[index].generation != id.value >> index_bits)
        return false;
    remove(joints_[index]);
    return true;
}

void JointTable::remove(Joint& joint) {
    system_.GetBodyInterfaceNoLock().ActivateConstraint(joint.constraint);
    system_.RemoveConstraint(joint.constraint);
    joint.constraint = nullptr;
    joint.axes = {};
    --count_;
    joint.generation = (joint.generation + 1) & (index_mask >> 1);
}

void JointTable::remove_all_of(const JPH::Body& body) {
    for (Joint& joint : joints_)
        if (joint.holds(body))
            remove(joint);
}

void JointTable::forget_impulses_of(const JPH::Body& body) {
    for (const Joint& joint : joints_)
        if (joint.holds(body))
            joint.constraint->ResetWarmStart();
}

void JointTable::shape_changed(const JPH::Body& body, JPH::Vec3Arg way) {
    for (Joint& joint : joints_)
        if (joint.constraint != nullptr)
            joint.constraint->NotifyShapeChanged(body.GetID(), way);
}

void JointTable::begin_step(JointSwing& swing) {
    swing.clear();
    if (count_ == 0)
        return;
    for (Joint& joint : joints_)
        for (JointAxis& axis : joint.axes)
            axis.drive();
    for (const Joint& joint : joints_)
        if (joint.constraint != nullptr && joint.holds_point)
            swing.begin_step(*joint.constraint->GetBody1(), *joint.constraint->GetBody2(),
                             joint.constraint->GetConstraintToBody1Matrix().GetTranslation(),
                             joint.constraint->GetConstraintToBody2Matrix().GetTranslation());
}

void JointTable::save(JPH::StateRecorder& writer) const {
    for (const Joint& joint : joints_) {
        if (joint.constraint == nullptr)
            continue;
        std::uint8_t return_bits = 0;
        for (std::size_t i = 0; i < joint.axes.size(); ++i)
            return_bits |= static_cast<std::uint8_t>(joint.axes[i].returns() ? 1u << i : 0u);
        writer.Write(return_bits);
    }
}

void JointTable::restore(JPH::StateRecorder& reader) {
    for (Joint& joint : joints_) {
        if (joint.constraint == nullptr)
            continue;
        std::uint8_t return_bits = 0;
        reader.Read(return_bits);
        for (std::size_t i = 0; i < joint.axes.size(); ++i)
            joint.axes[i].set_returns((return_bits >> i & 1u) != 0);
    }
}

void JointTable::join_group(JPH::Body& body) {
    if (!body.GetID().IsInvalid())  // the world itself has no place among the bodies
        body.SetCollisionGroup({this, body.GetID().GetIndexAndSequenceNumber(), 0});
}

bool JointTable::CanCollide(const JPH::CollisionGroup& a, const JPH::CollisionGroup& b) const {
    // The world has no group of its own, nor has a body in no joint: both would seem to be joined.
    constexpr JPH::CollisionGroup::GroupID none = JPH::CollisionGroup::cInvalidGroup;
    if (a.GetGroupID() == none || b.GetGroupID() == none) {
        return true;
    }
    return std::none_of(joints_.begin(), joints_.end(), [&a, &b](const Joint& joint) {
        return joint.constraint != nullptr && !joint.bodies_collide &&
               ((joint.first == a.GetGroupID() && joint.second == b.GetGroupID()) ||
                (joint.first == b.GetGroupID() && joint.second == a.GetGroupID()));
    });
}

}  // namespace tactus
