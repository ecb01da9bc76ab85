// Places that the far side sees only roughly, as a camera does, made steady.
//
// What was received is compared with where the model, which began from the last filtered place, expects the
// body to be at that sample. Chance changes the difference y from one state to the next; what the model gets
// wrong stays. With the mean squares
//
//     n = mean of |y_k - y_(k-1)|^2 / 2      chance
//     s = mean of y_k . y_(k-1)              what stays
//
// the share of a difference that is believed is s / (s + n), at least as much as a mean over what the body
// has been at rest for. Where n is below what a right model and an honest far side differ by, all is
// believed, to the last bit.
#pragma once

#include <cstdint>

#include "core/teleop/body_motion.hpp"

namespace tactus {

struct PoseFilterSettings {
    double trusted =
        1e-4;             // chance below this is none: places are believed as they come (unit: meters), >= 0
    double memory = 0.2;  // of the mean squares (unit: seconds), > 0
    double still_speed =
        2e-3;  // a body that is slower and that nothing pushes rests (unit: meters per second)
    double still_spin = 0.02;   // (unit: radians per second)
    double most_at_rest = 200;  // states that are averaged over at rest, >= 1
};

class PoseFilter {
public:
    // `expected`: by the model at the same sample; `seconds` since the state before. What is to be believed.
    BodyMotion filter(const PoseFilterSettings& settings, const BodyMotion& received,
                      const BodyMotion& expected, double seconds);

    void forget() { *this = {}; }
    double chance() const { return chance_; }  // mean square (unit: square meters)

private:
    bool known_ = false;
    Vec3 before_{0.0};      // the last difference (unit: meters)
    double chance_ = 0.0;   // n
    double stays_ = 0.0;    // s
    double at_rest_ = 0.0;  // states since the body rests
};

}  // namespace tactus
