#include "core/math/body_motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

double angle_between(const Quat& from, const Quat& to) {
    const Quat turn = to * glm::conjugate(from);
    // The arc sine of the vector part keeps its digits for small angles, where the arc cosine loses them.
    const double half_sine = std::min(1.0, glm::length(Vec3(turn.x, turn.y, turn.z)));
    return 2.0 * std::asin(half_sine);
}

Vec3 turn_vector(const Quat& turn) {
    const double sign = turn.w < 0.0 ? -1.0 : 1.0;
    const Vec3 axis = sign * Vec3(turn.x, turn.y, turn.z);
    const double sine = glm::length(axis);
    return sine > 0.0 ? axis * (2.0 * std::atan2(sine, sign * turn.w) / sine) : Vec3(0.0);
}

Quat turn_by(const Vec3& angular_velocity, double seconds) {
    const double angle = glm::length(angular_velocity) * seconds;
    if (!(std::abs(angle) > 0.0)) {
        return {1.0, 0.0, 0.0, 0.0};
    }
    return glm::angleAxis(angle, glm::normalize(angular_velocity));
}

Pose carried_on(const Pose& pose, const Vec3& linear_velocity, const Vec3& angular_velocity, double seconds) {
    return {pose.position + seconds * linear_velocity,
            glm::normalize(turn_by(angular_velocity, seconds) * pose.rotation)};
}

bool poses_differ(const Pose& a, const Pose& b, const MotionThreshold& threshold) {
    return glm::length(a.position - b.position) > threshold.position ||
           angle_between(a.rotation, b.rotation) > threshold.angle;
}

bool differs(const BodyMotion& a, const BodyMotion& b, const MotionThreshold& threshold) {
    return poses_differ(a.pose, b.pose, threshold) ||
           glm::length(a.linear_velocity - b.linear_velocity) > threshold.linear_velocity ||
           glm::length(a.angular_velocity - b.angular_velocity) > threshold.angular_velocity;
}

}  // namespace tactus
