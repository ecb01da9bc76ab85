// What soft fingers hold against turning, held against Coulomb: whole sessions in virtual time.
#pragma once

#include "core/tool/soft_finger.hpp"

namespace tactus::shared {

struct TorsionFigures {
    double break_away_error = 0.0;  // of the torque at which the body begins to turn (unit: percent)
    double slipping_error = 0.0;    // of the torque that holds it back while it turns (unit: percent)
};

// Two fingers hold a cube in free space from both sides, and it is turned about the line between them.
TorsionFigures turn_held_cube(double edge, double pressing);

struct LiftFigures {
    double turned = 0.0;  // the most within five seconds (unit: degrees)
    double risen = 0.0;   // at their end (unit: meters)
};

// Two fingers lift a box of 0.2 kg 20 mm beside its middle.
LiftFigures lift_beside_middle(const SoftFinger& finger);

}  // namespace tactus::shared
