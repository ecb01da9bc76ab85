#include "physics/spring_push.hpp"

#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/BodyManager.h>
#include <Jolt/Physics/IslandBuilder.h>
#include <Jolt/Physics/LargeIslandSplitter.h>

#include <algorithm>

#include "physics/jolt_units.hpp"
#include "physics/least_exact_mass.hpp"
#include "physics/limits.hpp"

namespace tactus {

namespace {

// Jolt's own cannot be made on its own.
struct PlainSettings final : JPH::ConstraintSettings {};

// A body is light to a spring when k dt^2 exceeds this share of its mass.
constexpr float light = 0.05f;
// Up to this one a free body is stable under the force of the step's begin (see the header).
constexpr float explicit_limit = 2.0f;

// The share s of a free body (see the header): enough to come to rest in the end, too little to tell.
constexpr float least_share = 0.01f;

// Contacts of a single light body settle to a thousandth within the first, spring and contacts together in
// the rest.
constexpr int held_iterations = 24;
constexpr JPH::uint light_iterations = 40;

// The velocity of the point for a unit impulse there: 1/m - [r] I^-1 [r].
JPH::Mat44 inverse_mass_at(const JPH::Body& body, JPH::Vec3Arg arm) {
    const JPH::MotionProperties& motion = *body.GetMotionProperties();
    const JPH::Mat44 cross = JPH::Mat44::sCrossProduct(arm);
    const JPH::Mat44 turning =
        cross.Multiply3x3(motion.GetInverseInertiaForRotation(JPH::Mat44::sRotation(body.GetRotation())))
            .Multiply3x3(cross.Transposed3x3());
    return JPH::Mat44::sScale(motion.GetInverseMass()) + turning;
}

}  // namespace

SpringPush::SpringPush() : JPH::Constraint(PlainSettings()) {
    SetEmbedded();  // lives in the world, Jolt does not delete it
}

void SpringPush::set(JPH::Body& body, const SpringForce& spring) {
    const JPH::RVec3 point = units::position(spring.point);
    push_ = {};
    push_.body = &body;
    push_.sticks = spring.sticks;
    push_.force = units::vector(limits::cut(spring.force, limits::strongest));
    push_.direction = push_.force.Normalized();
    push_.local_point = body.GetRotation().Conjugated() * JPH::Vec3(point - body.GetCenterOfMassPosition());
    push_.start = point;
    push_.hand_velocity = along(units::vector(limits::cut(spring.hand_velocity, limits::fastest)));
    push_.first_velocity = along(body.GetPointVelocity(point));
    push_.stiffness = static_cast<float>(limits::cut(spring.stiffness, limits::stiffest));
    push_.damping = static_cast<float>(limits::cut(spring.damping, limits::stiffest));
    push_.all_stiffness = push_.stiffness;
    push_.all_damping = push_.damping;
    twist_.set(body, spring.twist);
}

void SpringPush::SetupVelocityConstraint(float seconds) {
    push_.impulse += of_sub_step();
    push_.turn += turn_of_sub_step();
    const JPH::MotionProperties& motion = *push_.body->GetMotionProperties();
    arm_ = push_.body->GetRotation() * push_.local_point;
    lever_ = arm_.Cross(push_.direction);
    turn_ = motion.MultiplyWorldSpaceInverseInertiaByVector(push_.body->GetRotation(), lever_);
    inverse_mass_along_ = motion.GetInverseMass() + lever_.Dot(turn_);
    const JPH::Vec3 gone = along(JPH::Vec3(push_.body->GetCenterOfMassPosition() - push_.start) + arm_);
    force_ = push_.force + push_.stiffness * (push_.hand_velocity * push_.elapsed - gone);
    push_.given += push_.elapsed > 0.0f ? given_along() : 0.0f;
    impulse_ = force_.Dot(push_.direction) > 0.0f ? force_ * seconds : JPH::Vec3::sZero();
    impulse_along_ = impulse_.Dot(push_.direction);
    push_.elapsed += seconds;

    const auto response = [&](float stiffness, float damping) {
        return inverse_mass_along_ * static_cast<float>(least_exact_mass(stiffness, damping, seconds));
    };
    is_light_ = response(push_.stiffness, push_.damping) > light;
    is_stable_ = response(push_.all_stiffness, push_.all_damping) <= explicit_limit;
    held_ = is_light_ ? held_iterations : 0;
    SetNumVelocityStepsOverride(is_light_ ? light_iterations : 0);
    gives_ = false;
    twist_.set_up(*push_.body, seconds);
}

// A braced body does not give way: the answer is the force itself, and the contacts remember theirs.
void SpringPush::WarmStartVelocityConstraint(float) {
    if (push_.sticks)
        add_impulse(impulse_);
    else
        add_impulse_along(impulse_along_);
    twist_.warm_start(*push_.body);
}

bool SpringPush::SolveVelocityConstraint(float seconds) {
    if (held_ > 0) {
        --held_;
        return true;  // or Jolt would think that it is done
    }
    if (!gives_)
        give_way(seconds);
    const bool pushed = push_.sticks ? solve() : solve_along();
    const bool held = twist_.solve(*push_.body);
    return pushed || held;
}

// In terms of the impulse l, with the hand's velocity w, the force of a sub-step is
//     l / dt = F0 + k (h - u) + s k dt (w - v) - s c (v - v0)
//     <=>   v + l / (dt s (c + k dt)) = (F0 + k (h - u) + s k dt w + s c v0) / (s (c + k dt)).
// A sliding fingertip solves it along n: numbers in place of vectors, n.v + (r x n).w in place of v.
//
// By now contacts, joints and other fingers have given what they gave in the last step, or what they found
// while the impulse was held: what of this impulse has not become speed is borne by them.
void SpringPush::give_way(float seconds) {
    const JPH::MotionProperties& motion = *push_.body->GetMotionProperties();
    const JPH::Vec3 velocity = motion.GetLinearVelocity() + motion.GetAngularVelocity().Cross(arm_);
    const float given = push_.given + given_along();
    const float gained = (velocity - push_.first_velocity).Dot(push_.direction);
    const float free = inverse_mass_along_ * given;  // what a free body would have gained
    const bool keeps = is_stable_ && gained > 0.0f && free > 0.0f;
    const float share = keeps ? std::clamp(1.0f - gained / free, least_share, 1.0f) : 1.0f;
    const float give = share * push_.stiffness * seconds;
    const float damping = share * push_.damping;
    const float resistance = damping + give;
    softness_ = 1.0f / (seconds * resistance);
    bias_ = (force_ + give * push_.hand_velocity + damping * push_.first_velocity) / resistance;
    bias_along_ = bias_.Dot(push_.direction);
    effective_mass_along_ = 1.0f / (inverse_mass_along_ + softness_);
    if (push_.sticks)
        effective_mass_ = (inverse_mass_at(*push_.body, arm_) + JPH::Mat44::sScale(softness_)).Inversed3x3();
    gives_ = true;
}

bool SpringPush::solve() {
    const JPH::MotionProperties& motion = *push_.body->GetMotionProperties();
    const JPH::Vec3 velocity = motion.GetLinearVelocity() + motion.GetAngularVelocity().Cross(arm_);
    const JPH::Vec3 before = impulse_;
    impulse_ = before - effective_mass_.Multiply3x3(velocity + softness_ * before - bias_);
    if (impulse_.Dot(push_.direction) < 0.0f)
        impulse_ = JPH::Vec3::sZero();
    add_impulse(impulse_ - before);
    return impulse_ != before;
}

bool SpringPush::solve_along() {
    const JPH::MotionProperties& motion = *push_.body->GetMotionProperties();
    const float velocity =
        push_.direction.Dot(motion.GetLinearVelocity()) + lever_.Dot(motion.GetAngularVelocity());
    const float before = impulse_along_;
    impulse_along_ =
        std::max(0.0f, before - effective_mass_along_ * (velocity + softness_ * before - bias_along_));
    add_impulse_along(impulse_along_ - before);
    return impulse_along_ != before;
}

void SpringPush::add_impulse(JPH::Vec3Arg impulse) {
    JPH::MotionProperties& motion = *push_.body->GetMotionProperties();
    motion.AddLinearVelocityStep(motion.GetInverseMass() * impulse);
    motion.AddAngularVelocityStep(
        motion.MultiplyWorldSpaceInverseInertiaByVector(push_.body->GetRotation(), arm_.Cross(impulse)));
}

void SpringPush::add_impulse_along(float impulse) {
    JPH::MotionProperties& motion = *push_.body->GetMotionProperties();
    motion.AddLinearVelocityStep((motion.GetInverseMass() * impulse) * push_.direction);
    motion.AddAngularVelocityStep(impulse * turn_);
}

void SpringPush::BuildIslands(JPH::uint32 index, JPH::IslandBuilder& islands, JPH::BodyManager&) {
    islands.LinkConstraint(index, push_.body->GetIndexInActiveBodiesInternal());
}

JPH::uint SpringPush::BuildIslandSplits(JPH::LargeIslandSplitter& splitter) const {
    return splitter.AssignToNonParallelSplit(push_.body);
}

}  // namespace tactus
