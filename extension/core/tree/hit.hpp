// What a sweep answers. Any number of spheres that move as one body are swept one after the other, each up to
// the least `t` so far.
#pragma once

#include <cstdint>

#include "core/math/types.hpp"

namespace tactus {

// A sphere's centre on its straight way, at start + t * motion for t in [0, 1].
struct SphereWay {
    Vec3 start;          // (unit: meters)
    Vec3 motion;         // (unit: meters)
    double distance;     // the sphere is stopped where a surface is as near as this (unit: meters) …
    double slack = 0.0;  // … and at most this much farther: what an iteration may leave (unit: meters)
};

struct Hit {
    static constexpr std::uint32_t no_triangle = 0xffff'ffffu;

    double t = 1.0;        // the way is free up to here; the limit that was asked for where nothing stops it
    bool found = false;    // a surface stops the sphere at t
    bool complete = true;  // false: the budget ran out, and what lies beyond t is not known
    // Slot of the triangle that stops it, in a tree; where not complete, of one that would stop it later.
    std::uint32_t triangle = no_triangle;

    bool is_free() const { return !found && complete; }
};

}  // namespace tactus
