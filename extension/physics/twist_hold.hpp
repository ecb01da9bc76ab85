// A patch of friction that holds a body against turning about one axis: private to physics/.
//
// A spring as in spring_push.hpp, in its angle: at the end of a step
//     t = -K (z + (w - s) dt),  |t| <= limit
// with z the body's twist past the patch when the step began, w and s the turning rates of body and patch
// about the axis at its end. Implicit, so it is stable for every inertia; the bound makes it Coulomb's
// friction.
#pragma once

#include "physics/jolt.hpp"
#include "physics/physics_world.hpp"

#include <Jolt/Physics/Body/Body.h>

namespace tactus {

class TwistHold {
public:
    void set(const JPH::Body& body, const TwistSpring& twist);
    void set_up(const JPH::Body& body, float seconds);
    void warm_start(JPH::Body& body) { add_impulse(body, impulse_); }
    // Whether anything has changed.
    bool solve(JPH::Body& body);
    // Angular, of the last sub-step, in the world.
    JPH::Vec3 impulse() const { return holds() ? axis_ * impulse_ : JPH::Vec3::sZero(); }

private:
    bool holds() const { return limit_ > 0.0f; }
    void add_impulse(JPH::Body& body, float impulse);

    // All in Jolt's units, in the world.
    JPH::Vec3 axis_ = JPH::Vec3::sAxisY();
    JPH::Quat start_ = JPH::Quat::sIdentity();  // the body's rotation when the step began
    float twist_ = 0.0f;                        // z
    float stiffness_ = 0.0f;                    // K
    float limit_ = 0.0f;
    float patch_spin_ = 0.0f;  // s
    float elapsed_ = 0.0f;     // since the step began (unit: seconds)

    JPH::Vec3 turn_ = JPH::Vec3::sZero();  // I^-1 axis
    float softness_ = 0.0f;                // turning rate the spring gives way by for a unit impulse
    float bias_ = 0.0f;                    // turning rate at which it would be slack
    float effective_inertia_ = 0.0f;
    float max_impulse_ = 0.0f;  // impulse in a sub-step
    float impulse_ = 0.0f;
};

}  // namespace tactus
