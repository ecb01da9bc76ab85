// Where a body is and how it moves, and how far apart two such states are.
#pragma once

#include <cstdint>

#include "core/math/pose.hpp"

namespace tactus {

struct BodyMotion {
    Pose pose;                   // of the body in the world
    Vec3 linear_velocity{0.0};   // of the centre of mass (unit: meters per second)
    Vec3 angular_velocity{0.0};  // (unit: radians per second)
};

// A difference that is worth a correction. Below all of them the model counts as right.
struct MotionThreshold {
    double position = 1e-5;          // (unit: meters), >= 0
    double angle = 1e-4;             // (unit: radians), >= 0
    double linear_velocity = 1e-3;   // (unit: meters per second), >= 0
    double angular_velocity = 1e-2;  // (unit: radians per second), >= 0
};

// The angle of the turn that takes `from` to `to`, 0 … pi (unit: radians).
double angle_between(const Quat& from, const Quat& to);

// The turn as a vector along its axis, no longer than pi (unit: radians).
Vec3 turn_vector(const Quat& turn);

// The turn of length |w| t about w.
Quat turn_by(const Vec3& angular_velocity, double seconds);

// Where it is after that time if it goes on so: the way and the turn of that time.
Pose carried_on(const Pose& pose, const Vec3& linear_velocity, const Vec3& angular_velocity, double seconds);

bool poses_differ(const Pose& a, const Pose& b, const MotionThreshold& threshold);
bool differs(const BodyMotion& a, const BodyMotion& b, const MotionThreshold& threshold);

// The rigid motion D of the world that takes a body at `from` to `to`: to = D from.
inline Pose displacement(const Pose& from, const Pose& to) {
    const Quat turn = to.rotation * glm::conjugate(from.rotation);
    return {to.position - turn * from.position, turn};
}

// `was`, with those parts of `pose` that are written: bits 0 to 2 of `axes` for x, y and z of the position,
// bit 3 for the rotation.
inline Pose written(const Pose& was, const Pose& pose, std::uint32_t axes) {
    Pose now{was.position, (axes >> 3 & 1u) != 0 ? pose.rotation : was.rotation};
    for (int i = 0; i < 3; ++i) {
        now.position[i] = (axes >> i & 1u) != 0 ? pose.position[i] : was.position[i];
    }
    return now;
}

// The velocities of `was`, with those parts of `motion` that are written: bits 0 to 2 of `axes` for x, y and
// z of the linear velocity, bits 3 to 5 for those of the angular one. The pose is that of `was`.
inline BodyMotion with_velocity(const BodyMotion& was, const BodyMotion& motion, std::uint32_t axes) {
    BodyMotion now = was;
    for (int i = 0; i < 3; ++i) {
        now.linear_velocity[i] = ((axes >> i & 1u) != 0 ? motion : was).linear_velocity[i];
        now.angular_velocity[i] = ((axes >> (i + 3) & 1u) != 0 ? motion : was).angular_velocity[i];
    }
    return now;
}

// Moved, and turned about its own position.
inline Pose shifted(const Pose& pose, const Vec3& by, const Quat& turn) {
    return {pose.position + by, glm::normalize(turn * pose.rotation)};
}

// The same motion, seen from the parent of a frame that stands still, or from that frame.
inline BodyMotion to_parent(const Pose& frame, const BodyMotion& motion) {
    return {compose(frame, motion.pose), direction_to_parent(frame, motion.linear_velocity),
            direction_to_parent(frame, motion.angular_velocity)};
}
inline BodyMotion to_local(const Pose& frame, const BodyMotion& motion) {
    return {compose(inverse(frame), motion.pose), direction_to_local(frame, motion.linear_velocity),
            direction_to_local(frame, motion.angular_velocity)};
}

}  // namespace tactus
