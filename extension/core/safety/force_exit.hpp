// The one place through which a force leaves for a device: limited in size, in how fast it changes, and in
// how much energy it gives the hand.
//
// All three hold in every tick, whatever comes in, since a force may always be let go of: it lies within the
// slew's step (and of what the hand has changed itself) of some part of the one before, t F_before with 0 <=
// t <= 1. Of that set, of the ball of the largest force and of the half-space of the power, none is without
// the shorter ones of a force that is in it.
#pragma once

#include <glm/geometric.hpp>

#include "core/math/types.hpp"

namespace tactus {

struct ForceLimits {
    double slew = 2000.0;  // most change of the force (unit: newtons per second), > 0
    double energy = 1.0;   // most that is given to the hand at once (unit: joules), > 0
    double power = 5.0;    // and in the long run (unit: watts), > 0
};

class ForceExit {
public:
    // The force for the coming tick (unit: newtons). `velocity` is that of the hand in the device's own
    // measure (unit: meters per second). `own_change`: how much of the force's change in this tick is the
    // hand's own doing, at a model that has stayed what it was (unit: newtons); the slew limit is for the
    // rest. `limited`: the force asked for was another one.
    Vec3 leave(const ForceLimits& limits, const Vec3& wanted, double most, const Vec3& velocity,
               double seconds, double own_change, bool& limited);

    // The device rests: what comes next begins at nothing.
    void rest() { last_ = Vec3(0.0); }

private:
    Vec3 last_{0.0};
    double given_ =
        0.0;  // to the hand, less what it gave back and what time allows; 0 … energy (unit: joules)
};

}  // namespace tactus
