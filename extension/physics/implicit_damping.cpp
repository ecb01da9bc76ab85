#include "physics/implicit_damping.hpp"

namespace tactus {

void ImplicitDamping::begin_step(std::span<const JPH::BodyID> active, std::span<BodyRecord* const> records,
                                 float seconds) {
    damped_.clear();
    for (const JPH::BodyID id : active) {
        const BodyRecord& record = *records[id.GetIndex()];
        if ((record.linear_damping == 0.0 && record.angular_damping == 0.0) || !record.in_world->IsDynamic())
            continue;
        JPH::MotionProperties& motion = *record.in_world->GetMotionProperties();
        damped_.push_back({&motion, motion.GetInverseMass(), motion.GetInverseInertiaDiagonal(),
                           motion.GetGravityFactor()});
        const float linear = 1.0f / (1.0f + static_cast<float>(record.linear_damping) * seconds);
        const float angular = 1.0f / (1.0f + static_cast<float>(record.angular_damping) * seconds);
        motion.SetLinearVelocity(linear * motion.GetLinearVelocity());
        motion.SetAngularVelocity(angular * motion.GetAngularVelocity());
        motion.SetGravityFactor(linear * motion.GetGravityFactor());
        motion.SetInverseMass(linear * motion.GetInverseMass());
        motion.SetInverseInertia(angular * motion.GetInverseInertiaDiagonal(), motion.GetInertiaRotation());
    }
}

void ImplicitDamping::end_step() {
    for (const Damped& damped : damped_) {
        damped.motion->SetGravityFactor(damped.gravity_factor);
        damped.motion->SetInverseMass(damped.inverse_mass);
        damped.motion->SetInverseInertia(damped.inverse_moments, damped.motion->GetInertiaRotation());
    }
}

}  // namespace tactus
