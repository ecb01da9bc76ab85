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

}  // namespace tactus::shared
