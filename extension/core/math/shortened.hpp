#pragma once

#include <glm/geometric.hpp>

#include "core/math/types.hpp"

namespace tactus {

// The same direction, no longer than `most`.
inline Vec3 shortened(const Vec3& vector, double most) {
    const double length = glm::length(vector);
    return length > most ? vector * (most / length) : vector;
}

}  // namespace tactus
