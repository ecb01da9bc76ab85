// A robot that goes where an operator's hand is: what its motors are asked for, and what of it is contact.
//
//   drive     F = k (x_d - x) + d (x_d' - x'): a wall that follows the hand, as stiff as the robot's own
//   damping
//             and lag allow (core/safety/stiffness_limit.hpp).
//   contact   m x'' = F - f(x') + h, with friction f. The momentum observer (De Luca and others 2006)
//                 r = L (m x' - integral of (F - f(x') + r) dt)
//             is h behind a first-order low-pass of bandwidth L, and needs no acceleration and no force
//             sensor. Where x' is told smoothed, F is smoothed alike: else each change of F, which moves the
//             robot at once, would pass for contact.
//
// Pure values: no clock, no allocation.
#pragma once

#include "core/math/types.hpp"
#include "core/safety/stiffness_limit.hpp"

namespace tactus {

struct RobotBody {
    double mass = 0.0;      // of what moves with its tip (unit: kilograms), > 0
    double viscous = 0.0;   // friction (unit: newton seconds per meter), >= 0
    double coulomb = 0.0;   // friction (unit: newtons), >= 0
    double smoothed = 0.0;  // its velocity as it is told, to first order (unit: seconds), >= 0
};

// What friction takes at this velocity (unit: newtons).
Vec3 friction_of(const RobotBody& body, const Vec3& velocity);

Vec3 drive_force(const Wall& coupling, const Vec3& wanted, const Vec3& wanted_velocity, const Vec3& position,
                 const Vec3& velocity);

// How fast the target of a hand that moves with `told` may go: a twentieth faster than the hand, and at most
// 0.2 m/s where that is slower. A robot hits with its mass, so that one that has missed samples does not
// hurry after them (unit: meters per second).
double follow_speed(double told, double most);

// Where the robot is sent in this tick: towards the hand, no faster than `speed`, and no farther from the
// middle of its workspace than `radius` (units: meters, meters per second).
Vec3 next_target(const Vec3& before, const Vec3& hand, double speed, const Vec3& middle, double radius,
                 double seconds);

// The same of its turn: a torque, and where it is turned in this tick, no faster than `spin` (units: newton
// meters, radians per second).
Vec3 drive_torque(const Wall& coupling, const Quat& wanted, const Vec3& wanted_spin, const Quat& rotation,
                  const Vec3& spin);
Quat next_turn(const Quat& before, const Quat& hand, double spin, double seconds);

// Of a turn it is as good: with torques, spin and inertia in place of forces, velocity and mass.
class ContactObserver {
public:
    static constexpr double bandwidth = 200.0;  // L (unit: radians per second)

    // What the surroundings push the robot with, seen at the end of a tick in which the motors gave `drive`
    // (unit: newtons).
    Vec3 observe(const RobotBody& body, const Vec3& drive, const Vec3& velocity, double seconds);
    void reset() { *this = {}; }

private:
    bool begun_ = false;
    Vec3 drive_{0.0};      // as late as the velocity (unit: newtons)
    Vec3 explained_{0.0};  // momentum that drive, friction and contact have given (unit: newton seconds)
    Vec3 contact_{0.0};
};

}  // namespace tactus
