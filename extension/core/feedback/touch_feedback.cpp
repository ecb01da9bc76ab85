#include "core/feedback/touch_feedback.hpp"

#include <algorithm>

namespace tactus {

namespace {

// Of a tick that comes after a pause: what was missed is not made up for.
constexpr Nanoseconds longest_tick = 10'000'000;

}  // namespace

void TouchFeedback::hear(Nanoseconds time, const TouchSample& sample, const MotorSettings& motors,
                         bool has_sound) {
    const double seconds = to_seconds(std::clamp(time - heard_, Nanoseconds{1}, longest_tick));
    heard_ = time;
    const double vibration = vibration_.next(sample, seconds);
    meter_.add(vibration, sample.force, seconds);
    if (has_sound) {
        sound_.append(vibration, vibration_.tap(), seconds, 1.0 / motors.full_force, samples_);
    }
}

void TouchFeedback::fall_silent() {
    vibration_ = {};
    meter_ = {};
    samples_.clear();
}

}  // namespace tactus
