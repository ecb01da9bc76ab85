// Devices do send numbers that are none: such a hand is where it was last.
#pragma once

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/pose.hpp"

namespace tactus {

inline bool is_hand_place(const Vec3& position) {
    constexpr double farthest = 1e9;  // (unit: meters)
    const Vec3 size = glm::abs(position);
    return size.x <= farthest && size.y <= farthest && size.z <= farthest;
}

inline bool is_hand_pose(const Pose& pose) {
    constexpr double off_unit = 1e-3;  // of a rotation's squared length
    const double squared = glm::dot(pose.rotation, pose.rotation);
    return is_hand_place(pose.position) && squared >= 1.0 - off_unit && squared <= 1.0 + off_unit;
}

}  // namespace tactus
