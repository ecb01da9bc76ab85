// Two sides that differ in what both must agree on (network/terms.hpp), from the start or from some time in
// play on: whether any hand presses or feels something all the same, and whether both sides say what differs.
// In virtual time.
#pragma once

#include <string>
#include <vector>

#include "core/teleop/passivity.hpp"

namespace tactus::shared {

// Of one side.
struct AgreementSide {
    int scenario = 4;  // 2 … 5
    Passivity passivity = Passivity::none;
    double impedance = 20.0;  // of wave variables (unit: newton-seconds per meter)
    double radius = 0.01;     // of the fingertip (unit: meters)
    bool has_hand = true;     // else the far side has nothing that stands in for the operator's
    double bar = 0.0;  // half the length of a tool in place of the fingertip (unit: meters); 0: a fingertip
    std::size_t bodies = 1;  // in the scene: a floor and what is out of reach
    std::size_t max_bodies = 64;
};

struct AgreementCase {
    std::string name;
    AgreementSide near, far;
    bool in_play = false;  // both are as `before` first, and press
    AgreementSide before;
    bool alike = false;  // nothing differs: both are to press
};

struct AgreementFigures {
    double near_force = 0.0, far_force = 0.0;  // most, from 0.3 s after they differ on (unit: newtons)
    double largest_step = 0.0;                 // of either in a tick (unit: newtons)
    bool near_says = false, far_says = false;
};

std::vector<AgreementCase> agreement_cases();
AgreementFigures run_agreement(const AgreementCase& one);

}  // namespace tactus::shared
