#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/types.hpp"

namespace tactus {

// A unit vector across a unit vector, the same whenever it is asked for.
inline Vec3 any_perpendicular(const Vec3& n) {
    const Vec3 other = std::abs(n.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    return glm::normalize(glm::cross(n, other));
}

}  // namespace tactus
