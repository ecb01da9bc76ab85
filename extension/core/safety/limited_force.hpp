#pragma once

#include <cmath>

#include "core/math/shortened.hpp"

namespace tactus {

// A shorter force is none: it comes from rounding (unit: newtons).
inline constexpr double no_force = 1e-9;

// The force, shortened to `limit` where it is longer; zero where it is not a number (unit: newtons).
inline Vec3 limited_force(const Vec3& force, double limit) {
    return std::isfinite(glm::length(force)) ? shortened(force, limit) : Vec3(0.0);
}

}  // namespace tactus
