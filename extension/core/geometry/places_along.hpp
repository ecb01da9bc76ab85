// Places along a way of straight pieces.
#pragma once

#include <vector>

#include "core/math/types.hpp"

namespace tactus {

// Without those that are nearer to the one before than that (unit: meters).
std::vector<Vec3> apart(const std::vector<Vec3>& places, double least);

}  // namespace tactus
