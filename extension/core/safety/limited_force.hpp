#pragma once

#include <cmath>

#include "core/math/shortened.hpp"

namespace tactus {

// The force, shortened to `limit` where it is longer; zero where it is not a number (unit: newtons).
inline Vec3 limited_force(const Vec3& force, double limit) {
    return std::isfinite(glm::length(force)) ? shortened(force, limit) : Vec3(0.0);
}

}  // namespace tactus
