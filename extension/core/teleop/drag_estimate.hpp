// What the model gets wrong about how a body slows down, learnt from what corrections bring: friction and
// mass that are not what they seem make it too fast or too slow by nearly the same deceleration each time.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

struct DragSettings {
    double gain = 0.05;  // share of what was seen that is learnt at once, 0 … 1; 0: nothing is learnt
    double slow = 0.02;  // below this speed nothing is learnt, and less is applied (unit: meters per second)
    double largest = 6.0;  // (unit: meters per second squared), >= 0
};

class DragEstimate {
public:
    // From the same state, the far side's body came to `truth` and the model's to `model` within `seconds`
    // (> 0).
    void learn(const DragSettings& settings, const Vec3& truth, const Vec3& model, double seconds);

    // What the model's body needs besides its own forces (unit: meters per second squared).
    Vec3 acceleration(const DragSettings& settings, const Vec3& velocity) const;

    double value() const { return drag_; }

private:
    double drag_ = 0.0;  // against the velocity (unit: meters per second squared)
};

}  // namespace tactus
