// What the safety layer is held against: random input of every kind, and contacts of a simulated arm.
#pragma once

#include <cstdint>

#include "core/safety/hand_safety.hpp"
#include "core/safety/stiffness_limit.hpp"

namespace tactus::shared {

struct SafetyFigures {
    std::int64_t inputs = 0;
    std::int64_t violations = 0;  // forces above a limit of size, slew, power or ramp, or where none may be
    std::int64_t working = 0;     // inputs that were given a force

    void add(const SafetyFigures& other);
};

// Plays `inputs` ticks of random forces, hands, buttons, faults and limits, and judges every force by itself.
SafetyFigures play_random_hand(std::uint64_t seed, std::int64_t inputs);

// An arm that presses a handle into a wall, holds on, and draws back.
struct ContactCase {
    Wall wall;
    LoopLag lag;
    double device_damping = 1.5;  // of the handle itself (unit: newton seconds per meter)
    double device_mass = 0.25;    // (unit: kilograms)
    bool limited = true;          // the wall is what safe_wall() makes of it
    bool passive = true;          // the passivity controller is on
};

struct ContactFigures {
    double stiffness_used = 0.0;  // (unit: newtons per meter)
    double energy_created =
        0.0;  // given to the hand over the contact, behind the handle's friction (unit: joules)
    double largest_created = 0.0;  // at any time of it (unit: joules)
    bool stable = false;           // the handle comes to rest against the wall
};

ContactFigures play_contact(const ContactCase& contact);

}  // namespace tactus::shared
