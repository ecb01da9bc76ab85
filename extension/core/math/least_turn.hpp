#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/types.hpp"

namespace tactus {

// The least turn that takes one unit vector to the other; half a turn about any axis across where they are
// opposite.
inline Quat least_turn(const Vec3& from, const Vec3& to) {
    const double cosine = glm::dot(from, to);
    if (cosine < -0.999999) {
        const Vec3 across =
            glm::cross(from, std::abs(from.x) < 0.7 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0));
        const Vec3 axis = glm::normalize(across);
        return {0.0, axis.x, axis.y, axis.z};
    }
    const Vec3 axis = glm::cross(from, to);
    return glm::normalize(Quat(1.0 + cosine, axis.x, axis.y, axis.z));
}

}  // namespace tactus
