// Spin that keeps its angular momentum: private to physics/.
//
// Jolt holds a body's angular velocity w constant over a step; of a body that is no ball, L = I(q) w changes
// with the rotation q. Here the torque-free rotation of the step is found first, and Jolt gets the constant
// velocity that leads to the same rotation. What its solver adds to it, dw, is a torque of contacts and
// joints. After the step
//     w' = I(q')^-1 (L + I(q) dw)
// so L changes by torques alone, to the last digit of single precision.
//
// The torque-free rotation exp(r) solves Euler's equations in the frame of the principal axes, with J = I^-1:
//     dR/dt = R [w],  w = J L,  dL/dt = L x w
// by the series of Magnus (1954) over the derivatives w0, w1, w2, w3 of w when the step begins:
//     r = h w0 + h^2/2 w1 + h^3/12 (2 w2 + w0 x w1) + h^4/24 (w3 + w0 x w2) + O(h^5)
// A fast spin takes several such parts. L is kept besides, so no spin gains more than L^2 / (2 I_min).
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
        Quat axes;      // frame of the principal axes in the world when the step began
        Vec3 momentum;  // then, along them
        Vec3 velocity;  // that leads to the torque-free rotation, in the world
    };
    std::vector<Spin> spins_;
};

}  // namespace tactus
