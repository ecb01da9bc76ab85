// A hand with a deadband whose link loses packets: over and over it comes down to a plate, stops above it or
// presses it. The far hand must not touch what the operator does not, nor press harder, nor get through. In
// virtual time, the same bits each run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "network/link_conditions.hpp"

namespace tactus::shared {

enum class LossyHand : std::uint8_t { fingertip, tool, robot };

struct LossyCase {
    std::string name;
    LossyHand hand = LossyHand::fingertip;
    LinkConditions conditions;  // both ways
    double outage = 0.0;        // nothing gets through for so long, once in each second run (unit: seconds)
    bool presses = false;       // else it stops above the plate
    bool is_direct = false;     // without a model
};

struct LossyFigures {
    int touches = 0;         // times that the far hand has begun to touch, where the operator never does
    int beyond = 0;          // ticks in which the far hand is beyond the plate's surface
    double far_force = 0.0;  // the most (unit: newtons)
    double own_force = 0.0;  // of the operator's hand, the most (unit: newtons)
    bool agreed = false;     // the two sides have met

    double excess() const { return far_force - own_force; }
};

std::vector<LossyCase> lossy_cases();
LossyFigures run_lossy(const LossyCase& one, std::uint64_t seed);

// The operator's hand presses and goes while it does: its pointer is switched off, or its device is gone.
// Half a second later it is there again, inside the plate. Or another device takes its place at once, deeper
// in the plate. Or its clutch is held, so that it is there and is given no force.
enum class Absence : std::uint8_t { pointer, device, another_device, clutch };
struct AbsentFigures {
    double pressed = 0.0;  // by the far hand, before (unit: newtons)
    double away = 0.0;     // by it, when the hand has been away for 0.5 s (unit: newtons)
    LossyFigures back;     // from then on, for two seconds
    double lasting = 0.0;  // by it, the most in the second of them (unit: newtons)
};
AbsentFigures run_absent(LossyHand hand, Absence absence, bool is_direct = false);

// The operator's hand goes around a post, touching nothing, while nothing gets through for a time (unit:
// seconds).
struct AroundFigures {
    double far_force = 0.0;  // the most (unit: newtons)
    double lasting = 0.0;    // in the last second of the three after it (unit: newtons)
    double own_force = 0.0;  // of the operator's hand, the most (unit: newtons)
};
AroundFigures run_around(LossyHand hand, double outage);

}  // namespace tactus::shared
