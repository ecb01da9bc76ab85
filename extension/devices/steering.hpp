// Keys, sticks and caps as a hand: they say in which direction and how much, not where. A deflection is a
// vector of length 0 to 1, one axis each for right, up and towards the user.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

enum class SteeringMode {
    rate,      // a deflection is a velocity: any place is reached, and the hand stays where it was let go
    position,  // a deflection is a place: the hand is back where it began once it is let go
};

struct SteeringInput {
    Vec3 deflection{0.0};       // right, up, towards the user
    std::uint32_t buttons = 0;  // bit i: button i is held
};

struct SteeringSettings {
    SteeringMode mode = SteeringMode::rate;
    double reach = 0.2;      // the hand goes no farther from where it began (unit: meters)
    double speed = 0.1;      // rate: of a full deflection (unit: meters per second)
    double dead_zone = 0.1;  // deflections up to this are none: a stick at rest is never quite at 0; < 1
};

// What is left of a deflection beyond the dead zone, stretched so that it begins at 0 and ends at 1; longer
// ones, as of two axes that are both full, are shortened to 1.
Vec3 effective_deflection(const Vec3& deflection, double dead_zone);

// Where the hand is wanted `seconds` later, in the frame of the deflection, about where it began (unit:
// meters).
Vec3 steered(const Vec3& place, const Vec3& deflection, const SteeringSettings& settings, double seconds);

}  // namespace tactus
