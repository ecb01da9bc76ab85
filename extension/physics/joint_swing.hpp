// Hinges and pins that do not brake what swings about them: private to physics/.
//
// Jolt solves a joint's velocity, u = 0 at its point, before it turns the bodies. Their arms r turn with
// them, so that the next step begins with u = c, c = w x (r' - r) of one body less that of the other, and
// takes it away: an impulse -K^-1 c that loses c K^-1 c / 2 of energy, for a body on a fixed hinge
// w^2 dt m r^2 / (m r^2 + I) of its energy a second. A joint whose velocity is right in the middle of the
// step, u = -c / 2 before and c / 2 after it, loses nothing. So after each step the joint gives the impulse
// that it should have given before it, at the arms of then: -K^-1 c / 2.
#pragma once

#include <vector>

#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/Body.h>

namespace tactus {

class JointSwing {
public:
    explicit JointSwing(std::size_t max_joints) { held_.reserve(max_joints); }

    // Before a step, for each joint that holds a point of both bodies. Points are in the frames of the
    // centers of mass.
    void clear() { held_.clear(); }
    void begin_step(JPH::Body& first, JPH::Body& second, JPH::Vec3Arg point1, JPH::Vec3Arg point2);
    // After it.
    void end_step();

private:
    struct Side {
        JPH::Body* body;
        JPH::Vec3 point;  // in the frame of the center of mass
        JPH::Vec3 arm;    // to it when the step began, in the world
        JPH::Mat44 inverse_inertia;
        float inverse_mass;
    };
    struct Held {
        Side first, second;
        JPH::Vec3 goal;             // of the velocity at the point
        JPH::Mat44 effective_mass;  // K^-1
    };

    static Side side_of(JPH::Body& body, JPH::Vec3Arg point);
    static JPH::Vec3 velocity(const Side& side);
    static JPH::Vec3 turned(const Side& side);
    static void look(Side& side);
    static void push(Side& side, JPH::Vec3Arg impulse);

    std::vector<Held> held_;
};

}  // namespace tactus
