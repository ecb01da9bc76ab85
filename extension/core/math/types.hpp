// The value types every layer shares. SI units throughout: metres, kilograms, seconds, newtons, radians.
// Right-handed, y up, like Godot. All of core/ computes in double precision.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace tactus {

using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;
using Quat = glm::dquat;

// A point on (or a span of) a steady clock. Nothing in core/ or session/ reads a clock: time comes in as an
// argument.
using Nanoseconds = std::int64_t;

constexpr Nanoseconds nanoseconds_per_second = 1'000'000'000;

constexpr double to_seconds(Nanoseconds span) {
    return static_cast<double>(span) * 1e-9;
}

// Rounded to the nearest nanosecond; exact for spans below about 104 days.
constexpr Nanoseconds from_seconds(double seconds) {
    return static_cast<Nanoseconds>(seconds * 1e9 + (seconds < 0.0 ? -0.5 : 0.5));
}

}  // namespace tactus
