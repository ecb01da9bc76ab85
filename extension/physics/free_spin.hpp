// Spin that keeps its angular momentum: private to physics/.
//
// Jolt holds a body's angular velocity w constant over a step; of a body that is no ball, L = I(q) w changes
// with the rotation q. Here the torque-free rotation of the step is found first, and Jolt gets the constant
// velocity that leads to the same rotation. What its solver adds to it, dw, is a torque of contacts and
// joints. After the step
//     w' = I(q')^-1 (L + I(q) dw)
// so L changes by torques alone, to the last digit of single precision.
//
// The torque-free rotation is composed of rotations about the principal axes,
//     x(h/2) y(h/2) z(h) y(h/2) x(h/2),   each by h L_i / I_i
// (Dullweber, Leimkuhler and McLachlan 1997), three of which make a step of fourth order (Yoshida 1990):
// symplectic and symmetric in time, so the energy of a spin does not drift; a product of rotations, so it is
// stable at every rate.
#pragma once

#include <span>
#include <vector>

#include "core/math/pose.hpp"
#include "physics/body_record.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/BodyID.h>

namespace tactus {

class FreeSpin {
public:
    explicit FreeSpin(std::size_t max_bodies) { spins_.reserve(max_bodies); }

    // Before a step of all bodies in `active`; forces wait to be applied. `records` is by the body's index.
    void begin_step(std::span<const JPH::BodyID> active, std::span<BodyRecord* const> records, float seconds);
    // After it.
    void end_step();

private:
    struct Spin {
        JPH::Body* body;
        JPH::Quat rotation;  // when the step began
        Vec3 momentum;       // then, in the world
        Vec3 velocity;       // that leads to the torque-free rotation
    };
    std::vector<Spin> spins_;
};

}  // namespace tactus
