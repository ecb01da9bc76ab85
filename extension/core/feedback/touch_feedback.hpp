// What a hand without motors of its own is given of its touch: it hears every tick, and answers how strongly
// to shake and what to play since it was last asked.
#pragma once

#include <utility>
#include <vector>

#include "core/feedback/touch_sound.hpp"
#include "core/feedback/touch_vibration.hpp"

namespace tactus {

class TouchFeedback {
public:
    // `sound_rate`: samples a second.
    explicit TouchFeedback(double sound_rate) : sound_(sound_rate) {}

    // A tick at this time of the loop's clock. Without `has_sound` it makes no samples.
    void hear(Nanoseconds time, const TouchSample& sample, const MotorSettings& motors, bool has_sound);

    MotorLevels take_levels(const MotorSettings& motors) { return meter_.take(motors); }
    std::vector<float> take_samples() { return std::exchange(samples_, {}); }
    // What was heard so far counts no more.
    void fall_silent();

private:
    Nanoseconds heard_ = 0;  // time of the last tick
    TouchVibration vibration_;
    MotorMeter meter_;
    TouchSound sound_;
    std::vector<float> samples_;
};

}  // namespace tactus
