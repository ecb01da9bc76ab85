#include "core/feedback/touch_sound.hpp"

#include <cmath>

namespace tactus {

namespace {

constexpr double octaves_higher = 8.0;

}  // namespace

// A straight line from tick to tick; what is too loud is bent, not cut.
void TouchSound::append(double vibration, const Tap& tap, double seconds, double gain,
                        std::vector<float>& samples) {
    if (tap.size > 0.0) {
        ring_frequency_ = octaves_higher * tap.frequency;
        ring_.strike(tap);
    }
    owed_ += seconds * rate_;
    const int count = static_cast<int>(owed_);
    owed_ -= count;
    for (int i = 0; i < count; ++i) {
        ring_.advance(ring_frequency_, 1.0 / rate_);
        const double on_the_way = before_ + (vibration - before_) * (i + 1) / count;
        samples.push_back(static_cast<float>(std::tanh(gain * (on_the_way + ring_.sine))));
    }
    before_ = vibration;
}

}  // namespace tactus
