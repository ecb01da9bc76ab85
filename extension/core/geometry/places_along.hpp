// Places along a way of straight pieces.
#pragma once

#include <vector>

#include "core/math/types.hpp"

namespace tactus {

// Without those that are nearer to the one before than that (unit: meters).
std::vector<Vec3> apart(const std::vector<Vec3>& places, double least);

// So many, two or more, evenly along the way; the first and the last are its ends. A way of less than two
// places is as it is. No two neighbours of it are one place.
std::vector<Vec3> evenly_along(const std::vector<Vec3>& places, std::size_t count);

}  // namespace tactus
