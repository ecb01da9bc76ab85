#include "physics/joint_swing.hpp"

#include <algorithm>

namespace tactus {

namespace {

// Sweeps over joints that share bodies.
constexpr int sweeps = 4;

// Of the cross product: skew(r) x = r x x.
JPH::Mat44 skew(JPH::Vec3Arg r) {
    return JPH::Mat44::sCrossProduct(r);
}

// Of a unit impulse at the arm: 1 / m - [r] I^-1 [r].
JPH::Mat44 mobility(float inverse_mass, const JPH::Mat44& inverse_inertia, JPH::Vec3Arg arm) {
    const JPH::Mat44 cross = skew(arm);
    JPH::Mat44 result = cross.Multiply3x3(inverse_inertia).Multiply3x3RightTransposed(cross);
    for (unsigned i = 0; i < 3; ++i)
        result(i, i) += inverse_mass;
    return result;
}

}  // namespace

JointSwing::Side JointSwing::side_of(JPH::Body& body, JPH::Vec3Arg point) {
    return {&body, point, body.GetRotation() * point, JPH::Mat44::sZero(), 0.0f};
}

// At the arm of the step's beginning.
JPH::Vec3 JointSwing::velocity(const Side& side) {
    if (side.body->IsStatic())
        return JPH::Vec3::sZero();
    const JPH::MotionProperties& motion = *side.body->GetMotionProperties();
    return motion.GetLinearVelocity() + motion.GetAngularVelocity().Cross(side.arm);
}

// What the turn of the arm has changed the velocity of its end by.
JPH::Vec3 JointSwing::turned(const Side& side) {
    if (side.body->IsStatic())
        return JPH::Vec3::sZero();
    return side.body->GetMotionProperties()->GetAngularVelocity().Cross(
        side.body->GetRotation() * side.point - side.arm);
}

void JointSwing::look(Side& side) {
    if (!side.body->IsDynamic() || !side.body->IsActive())
        return;
    side.inverse_mass = side.body->GetMotionProperties()->GetInverseMass();
    side.inverse_inertia = side.body->GetInverseInertia();
}

void JointSwing::push(Side& side, JPH::Vec3Arg impulse) {
    if (side.inverse_mass == 0.0f)
        return;
    JPH::MotionProperties& motion = *side.body->GetMotionProperties();
    motion.SetLinearVelocity(motion.GetLinearVelocity() + side.inverse_mass * impulse);
    motion.SetAngularVelocity(motion.GetAngularVelocity() +
                              side.inverse_inertia.Multiply3x3(side.arm.Cross(impulse)));
}

void JointSwing::begin_step(JPH::Body& first, JPH::Body& second, JPH::Vec3Arg point1, JPH::Vec3Arg point2) {
    if (first.IsActive() || second.IsActive())
        held_.push_back(
            {side_of(first, point1), side_of(second, point2), JPH::Vec3::sZero(), JPH::Mat44::sZero()});
}

void JointSwing::end_step() {
    for (Held& held : held_) {
        look(held.first);
        look(held.second);
        const JPH::Mat44 inverse =
            mobility(held.first.inverse_mass, held.first.inverse_inertia, held.first.arm) +
            mobility(held.second.inverse_mass, held.second.inverse_inertia, held.second.arm);
        if (!held.effective_mass.SetInversed3x3(inverse))
            held.effective_mass = JPH::Mat44::sZero();
        held.goal =
            velocity(held.first) - velocity(held.second) - 0.5f * (turned(held.first) - turned(held.second));
    }
    for (int i = 0; i < sweeps; ++i)
        for (Held& held : held_) {
            const JPH::Vec3 impulse =
                held.effective_mass.Multiply3x3(held.goal - (velocity(held.first) - velocity(held.second)));
            push(held.first, impulse);
            push(held.second, -impulse);
        }
}

}  // namespace tactus
