#include "sensing/image/camera_clock.hpp"

#include <algorithm>
#include <cstdlib>

namespace tactus {

namespace {

// Clocks of cameras are off by less than a hundred millionths: half a millisecond within two of these.
constexpr Nanoseconds span = 2'500'000'000;

// No image is so late: the camera has set its clock.
constexpr Nanoseconds another_clock = 1'000'000'000;

}  // namespace

Nanoseconds CameraClock::taken_at(std::uint64_t stamp, Nanoseconds arrived) {
    const auto stamped = static_cast<Nanoseconds>(stamp) * 1000;
    const Nanoseconds apart = arrived - stamped;
    if (!is_known_ || std::abs(apart - std::min(least_[0], least_[1])) > another_clock) {
        least_ = {apart, apart};
        began_ = arrived;
        is_known_ = true;
    } else if (arrived - began_ > span) {
        least_ = {apart, least_[0]};
        began_ = arrived;
    }
    least_[0] = std::min(least_[0], apart);
    return stamped + std::min(least_[0], least_[1]);
}

}  // namespace tactus
