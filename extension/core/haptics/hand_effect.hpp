// Forces on the hand in closed form, computed at every tick: for a hand at x with the velocity v, a place c,
// a unit direction u, and the time t since the effect began,
//
//     constant  A u
//     spring    -K (x - c)
//     damper    -B v
//     friction  -K (x - a), where the anchor a is drawn along so that K |x - a| <= A
//     sine      A sin(2 pi t / period + phase) u
//     ramp      (A0 + (A - A0) min(t / duration, 1)) u
//     detent    -A sin(2 pi s / pitch) u with s = (x - c) . u: it rests at each multiple of the pitch
//     wall      max(0, K d - B v . u) u at a depth d = (c - x) . u > 0
//
// Spring, damper, friction, detent and wall are passive: over a closed way of the hand, after which they
// remember the same, their work on it is not positive. In the terms of SDL and OpenHaptics these are
// constant, spring, damper, friction, sine and ramp.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/haptics/surface_effects.hpp"
#include "core/math/types.hpp"
#include "core/safety/stiffness_limit.hpp"

namespace tactus {

struct HandEffect {
    enum class Form : std::uint8_t { none, constant, spring, damper, friction, sine, ramp, detent, wall };

    Form form = Form::none;
    Vec3 place{0.0};                // c, in the world (unit: meters)
    Vec3 direction{0.0, 1.0, 0.0};  // u, in the world
    double force = 1.0;             // A (unit: newtons)
    double first_force = 0.0;       // A0 (unit: newtons)
    double stiffness = 200.0;       // K (unit: newtons per meter), >= 0; of friction > 0
    double damping = 2.0;           // B (unit: newton seconds per meter), >= 0
    double period = 0.02;           // of a sine (unit: seconds), > 0
    double phase = 0.0;             // of a sine (unit: radians)
    double duration = 1.0;          // of a ramp (unit: seconds), > 0
    double pitch = 0.01;            // of detents (unit: meters), > 0

    bool operator==(const HandEffect&) const = default;
};

// Those of one hand.
struct HandEffects {
    static constexpr std::size_t most = 8;

    std::array<HandEffect, most> items{};
    std::size_t count = 0;

    bool operator==(const HandEffects&) const = default;
};

// What one of them remembers from tick to tick.
struct HandEffectMemory {
    HandEffect::Form form = HandEffect::Form::none;  // of the last tick
    Nanoseconds since = 0;
    Vec3 anchor{0.0};  // a, in the world (unit: meters)
};

// Whether its force is along its direction.
constexpr bool has_direction(HandEffect::Form form) {
    using Form = HandEffect::Form;
    return form != Form::none && form != Form::spring && form != Form::damper && form != Form::friction;
}

// Empty where it can be computed, or does nothing; otherwise what is wrong and what to do.
std::string check_effect(const HandEffect& effect);

// How steep it is at most.
Wall steepest(const HandEffect& effect);
// The same, with these shares of its stiffness and damping, 0 ... 1.
HandEffect weakened(HandEffect effect, double stiffness_share, double damping_share);

// On the hand in this tick (unit: newtons).
Vec3 effect_force(const HandEffect& effect, const HandMotion& hand, Nanoseconds now,
                  HandEffectMemory& memory);

}  // namespace tactus
