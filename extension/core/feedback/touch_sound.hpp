// Touch by ear: the vibration of a fingertip as samples of sound, and its taps three octaves higher, where
// they are heard best.
#pragma once

#include <vector>

#include "core/feedback/touch_vibration.hpp"

namespace tactus {

class TouchSound {
public:
    // `rate`: samples a second.
    explicit TouchSound(double rate) : rate_(rate) {}

    // Appends the samples of one tick of `seconds`, −1 to 1; `gain`: of a vibration of one newton. Over many
    // ticks none is too many or missing.
    void append(double vibration, const Tap& tap, double seconds, double gain, std::vector<float>& samples);

private:
    double rate_;
    double owed_ = 0.0;  // parts of a sample that time has gone on
    double before_ = 0.0;
    Ring ring_;
    double ring_frequency_ = 0.0;
};

}  // namespace tactus
