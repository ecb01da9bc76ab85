// Whether something can be touched where a scene has it.
#pragma once

#include <string>

#include "core/math/types.hpp"

namespace tactus {

// `axes` and `origin` of its frame in the world (unit: meters). What keeps it from being touched there, and
// what to do; empty where nothing does.
std::string problem_of_place(const Mat3& axes, const Vec3& origin);

}  // namespace tactus
