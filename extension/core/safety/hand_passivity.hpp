// The energy that flows at a hand, and what of a force may not be given because it would make some.
//
// A force is held for a tick, so the work it has done is exactly its product with the way that the hand went
// meanwhile: the observer (Hannaford and Ryu 2002) needs no velocity and no estimate. What the device's own
// friction takes on that way is at least b |way|^2 / seconds. The controller looks one tick ahead along the
// velocity; what it misses by that the next ticks take back.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

struct PassivitySample {
    Vec3 position{0.0};        // of the hand (unit: meters)
    Vec3 velocity{0.0};        // (unit: meters per second)
    double damping = 0.0;      // b, of the device itself (unit: newton seconds per meter), >= 0
    double max_damping = 0.0;  // that the controller may add (the same unit), >= 0
    double source =
        0.0;  // energy that the scene may give in this tick, as a body that moves does (unit: joules)
    double seconds = 0.001;  // of a tick
};

class HandPassivity {
public:
    // What of the force is given in the coming tick (unit: newtons).
    Vec3 pass(const PassivitySample& now, const Vec3& wanted);
    // What it has become behind limits.
    void given(const Vec3& force);
    // The hand is elsewhere, or nothing is felt any more.
    void reset() { *this = {}; }

    // Taken from the hand in this contact and not given back (unit: joules); below zero: made.
    double energy() const { return energy_; }

private:
    bool begun_ = false;
    Vec3 position_{0.0};
    Vec3 given_{0.0};
    double energy_ = 0.0;
};

}  // namespace tactus
