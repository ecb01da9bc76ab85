// Damping that is right at every step, for a body that is free and for one that is driven: private to
// physics/.
//
// Implicit in the step, with the forces F, what gravity gives, and the impulses l of contacts and joints:
//     (1 + c dt) v' = v + dt (g + F / m) + l / m
// so for the length of a step the velocity and gravity are divided by 1 + c dt, and the mass is multiplied by
// it. A free body stops after v / c, a driven one takes m c v.
#pragma once

#include <span>
#include <vector>

#include "physics/body_record.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/BodyID.h>

namespace tactus {

class ImplicitDamping {
public:
    explicit ImplicitDamping(std::size_t max_bodies) { damped_.reserve(max_bodies); }

    // Before a step of all bodies in `active`. `records` is by the body's index.
    void begin_step(std::span<const JPH::BodyID> active, std::span<BodyRecord* const> records, float seconds);
    // After it.
    void end_step();

private:
    struct Damped {
        JPH::MotionProperties* motion;
        // As they are outside the step.
        float inverse_mass;
        JPH::Vec3 inverse_moments;
        float gravity_factor;
    };
    std::vector<Damped> damped_;
};

}  // namespace tactus
