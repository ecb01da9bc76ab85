// A correction nobody feels (thesis 3.1.4). The object goes where it should be at once. The pointers travel
// with it, so that the force stays what it was, and what is then wrong about it fades more slowly than a hand
// can notice:
//     felt force = s T F(hand + offset)
// where `offset` is how far the pointers were carried, and T (a turn) and s (a factor) make up for what
// carrying cannot: an object that turned turns the force with it. All three fade to nothing. Without contact
// F is zero, so nothing is ever felt in free space, and the offset may fade fast there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/teleop/body_motion.hpp"

namespace tactus {

enum class Correction : std::uint8_t {
    none,                // the model is never corrected
    pose,                // at once, rates stay: the thesis's, which jitters
    pose_velocity,       // at once, with the rates
    stealthy_magnitude,  // pointers are carried; when the object turned, the force keeps its size
    stealthy_direction,  // the same, and the force keeps its direction as well
};

inline bool is_stealthy(Correction correction) {
    return correction == Correction::stealthy_magnitude || correction == Correction::stealthy_direction;
}

struct StealthSettings {
    double weber = 0.07;  // just-noticeable change of a force, as a share of it (facts: 0.07 … 0.10)
    double least_noticeable = 0.02;  // the same for a force near zero (unit: newtons), > 0
    double share = 0.5;              // of that, spent within one window, > 0
    double window = 0.1;             // in which a change counts as one change (unit: seconds), > 0
    double free_speed = 0.5;         // at which the offset fades in free space (unit: meters per second), > 0
    double longest_offset = 0.1;     // more is not carried (unit: meters), >= 0
};

// How fast corrections come that are each too small to notice. They come where the model drifts, and the
// drift takes back what they bring: fading as fast as they come changes nothing that can be felt.
class DriftRate {
public:
    // A correction has carried the pointers by `way`; of that, no more than `unnoticed` counts (unit:
    // meters).
    void carried(const StealthSettings& settings, double way, double unnoticed) {
        rate_ += std::min(way, unnoticed) / settings.window;
    }
    void pass(const StealthSettings& settings, double seconds) {
        rate_ *= std::exp(-seconds / settings.window);
    }
    double rate() const { return rate_; }  // (unit: meters per second)

private:
    double rate_ = 0.0;
};

// The change of a force of this size that can just be noticed (unit: newtons).
double just_noticeable(const StealthSettings& settings, double force);

// How much the felt force may change by within `seconds` because of fading (unit: newtons).
double unnoticed_change(const StealthSettings& settings, double force, double seconds);

// What makes up for the rest: felt = factor * (turn * modelled).
struct ForceBridge {
    Quat turn{1.0, 0.0, 0.0, 0.0};
    double factor = 1.0;

    bool is_none() const { return factor == 1.0 && turn == Quat(1.0, 0.0, 0.0, 0.0); }
    Vec3 felt(const Vec3& modelled) const { return factor * (turn * modelled); }
};

// The bridge from the force as it is modelled now to the one felt before. With `keep_direction` false only
// the size is kept. Forces too small to have a direction give none.
ForceBridge bridge(const Vec3& modelled, const Vec3& felt_before, bool keep_direction);

// The bridge after the felt force has changed by at most `change` (unit: newtons). Shared evenly between turn
// and factor.
ForceBridge faded(const ForceBridge& from, double modelled_force, double change);

// The offset after it has become shorter by at most `way` (unit: meters).
Vec3 faded(const Vec3& offset, double way);

}  // namespace tactus
