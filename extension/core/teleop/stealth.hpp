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

#include "core/math/body_motion.hpp"

namespace tactus {

enum class Correction : std::uint8_t {
    none,                // the model is never corrected
    pose,                // at once, rates stay: the thesis's, which jitters
    pose_velocity,       // at once, with the rates
    stealthy_magnitude,  // the force keeps its size; what its size would have changed by fades
    stealthy_direction,  // the force keeps size and direction; what it would have changed by fades
    stealthy_translate,  // pointers are carried by the object's way alone; as it turns, the force varies
    stealthy_turn,       // pointers are carried and turned with it; the force keeps its size in its frame
    passive,             // at once, with the rates; what that puts in is paid for (passive_update.hpp)
};

inline bool is_stealthy(Correction correction) {
    return correction >= Correction::stealthy_magnitude && correction <= Correction::stealthy_turn;
}
// A second pointer is carried along (thesis 3.1.4).
inline bool is_carrying(Correction correction) {
    return correction == Correction::stealthy_translate || correction == Correction::stealthy_turn;
}

struct StealthSettings {
    double weber = 0.07;  // just-noticeable change of a force, as a share of it (facts: 0.07 … 0.10)
    double least_noticeable = 0.02;  // the same for a force near zero (unit: newtons), > 0
    double share = 0.5;              // of that, spent within one window, > 0
    double window = 0.1;             // in which a change counts as one change (unit: seconds), > 0
    double free_speed = 0.5;         // at which the offset fades in free space (unit: meters per second), > 0
    double longest_offset = 0.1;     // more is not carried (unit: meters), >= 0
    double bound = 1.0;              // no more is hidden than this share of the modelled force, >= 0
    double masked = 0.1;  // of a change of force by the hand's own way, this share may fade, too, >= 0
    double let_go_seconds = 0.04;  // within which what is too large fades (unit: seconds), > 0
    double tank = 0.02;  // most energy that touch has taken and hiding may spend (unit: joules), >= 0
};

// How fast corrections come, one after the other. They come where the model drifts, and the drift takes back
// what they bring: fading as fast as they come changes nothing that can be felt. One large correction is no
// drift: the largest of those within the window does not count.
class DriftRate {
public:
    // A correction has brought `change` (unit: newtons).
    void carried(double change) {
        sum_ += change;
        largest_ = std::max(largest_, change);
    }
    void pass(const StealthSettings& settings, double seconds) {
        const double left = std::exp(-seconds / settings.window);
        sum_ *= left;
        largest_ *= left;
    }
    // (unit: newtons per second)
    double rate(const StealthSettings& settings) const { return (sum_ - largest_) / settings.window; }

private:
    double sum_ = 0.0, largest_ = 0.0;  // of what has come, each less by its age (unit: newtons)
};

// The change of a force of this size that can just be noticed (unit: newtons).
double just_noticeable(const StealthSettings& settings, double force);

// How much the felt force may change by within `seconds` because of fading (unit: newtons).
double unnoticed_change(const StealthSettings& settings, double force, double seconds);

// No more is hidden than is felt: it would be a force of its own (unit: newtons).
double max_hidden(const StealthSettings& settings, double modelled);

// What is left of it after it has become shorter by at most `way`.
Vec3 faded(const Vec3& from, double way);

}  // namespace tactus
