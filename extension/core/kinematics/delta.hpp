// A delta arm: three legs that turn a platform's place into three angles and back (Clavel 1988; Tsai and
// Stamper 1996). Pure functions on data; nothing here knows a device.
//
// In the frame of leg i (u outwards, v sideways, w along the device's axis, towards the hand) the platform's
// centre p is at
//     (Pu, Pv, Pw) = Rz(-phi_i) p - (r, s, 0),
// the upper arm of length a turns by theta1 about v, and a parallelogram of sides b between two bars d and e
// leads from its end to the platform, turned by theta2 about v and leaning sideways by theta3:
//     a cos(theta1) + L cos(theta2) = Pu + c
//     a sin(theta1) + L sin(theta2) = Pw              with  L = d + e + b sin(theta3)
//                  b cos(theta3)    = Pv + f.
// Differentiated and solved for theta1', with the unit vector along the parallelogram's long sides
//     rod = (cos(theta2) sin(theta3), cos(theta3), sin(theta2) sin(theta3)):
//     rod . p' = lever theta1',    lever = a sin(theta3) sin(theta2 - theta1).
// So the Jacobian's row is rod / lever. What a force F on the hand asks of the legs needs no division by it:
//     sum of pull_i rod_i = F,     torque_i = lever_i pull_i.
#pragma once

#include <array>

#include "core/math/types.hpp"

namespace tactus {

struct DeltaGeometry {
    double upper_arm = 0.0;              // a (unit: meters)
    double rod_length = 0.0;             // b (unit: meters)
    double platform_out = 0.0;           // c: from the platform's centre outwards (unit: meters)
    double bars = 0.0;                   // d + e (unit: meters)
    double platform_sideways = 0.0;      // f (unit: meters)
    double base_out = 0.0;               // r (unit: meters)
    double base_sideways = 0.0;          // s (unit: meters)
    std::array<double, 3> leg_angles{};  // phi (unit: radians)
    double gear = 1.0;                   // turns of the motor for one of the leg
    // What the stops allow of theta1 (unit: radians).
    double lowest_angle = 0.0;
    double highest_angle = 0.0;
};

constexpr double delta_degrees = 3.14159265358979323846 / 180.0;

// The Novint Falcon as libnifalcon measured it (FalconGeometry.h), and as quoted after Martin and Hillier,
// whose upper arms and rods are the same. The stops: what the published workspace (z from 75 to 175 mm)
// needs, and no more.
constexpr DeltaGeometry falcon_geometry{
    0.060,           0.1025, 0.01443,  0.0225,
    -0.025,          0.0400, -0.02309, {105.0 * delta_degrees, -15.0 * delta_degrees, -135.0 * delta_degrees},
    0.110 / 0.01425, -0.45,  1.35};
constexpr DeltaGeometry falcon_geometry_martin{
    0.060,  0.1025, 0.0157, 0.023,
    0.0262, 0.0366, 0.0272, {15.0 * delta_degrees, 255.0 * delta_degrees, 135.0 * delta_degrees},
    7.62,   -0.45,  1.35};

// Why a place or a pose is no good, or too near to being none.
enum class DeltaState : std::uint8_t {
    sound,
    beyond_stops,    // a leg's angle is outside what its stops allow
    leg_straight,    // upper arm and rod in one line: the leg holds whatever its motor does
    leg_sideways,    // the rods lie in the leg's axis: its motor moves nothing
    platform_loose,  // the rods span no volume: the platform gives way in one direction
    out_of_reach,    // there are no such angles
};

struct DeltaPose {
    DeltaState state = DeltaState::out_of_reach;
    Vec3 angles{0.0};            // theta1 of each leg (unit: radians)
    std::array<Vec3, 3> rods{};  // unit vectors
    Vec3 levers{0.0};            // (unit: meters)
    double volume = 0.0;         // spanned by the rods, -1 … 1
    // How far from being singular: 0 at the nearest singularity's limit, 1 from twice that on.
    double clearance = 0.0;
};

// From the platform's place to the legs. With the elbows outwards, as the arm is built. All but `state` is
// undefined where it is out of reach.
DeltaPose delta_pose(const DeltaGeometry& geometry, const Vec3& place);

struct DeltaPlace {
    Vec3 place{0.0};  // (unit: meters)
    bool found = false;
    int steps = 0;
};

// Where the platform is with these angles: Newton's method from `start`, which is best the place one tick
// ago; then two steps are enough. From `delta_centre` it finds every sound place.
DeltaPlace delta_place(const DeltaGeometry& geometry, const Vec3& angles, const Vec3& start);

// Amid the workspace.
Vec3 delta_centre(const DeltaGeometry& geometry);

// d theta1 / d place; row i is rods[i] / levers[i]. Needs levers that are not zero.
Mat3 delta_jacobian(const DeltaPose& pose);

// The place's velocity from the angles' (units: radians per second, meters per second).
Vec3 delta_velocity(const DeltaPose& pose, const Vec3& angle_rates);

// The legs' torques that push the hand with `force`, and the other way (units: newtons, newton meters).
Vec3 delta_torques(const DeltaPose& pose, const Vec3& force);
Vec3 delta_force(const DeltaPose& pose, const Vec3& torques);

}  // namespace tactus
