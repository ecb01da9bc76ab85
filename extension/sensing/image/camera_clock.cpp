#include "sensing/image/camera_clock.hpp"

#include <algorithm>
#include <cstdlib>

namespace tactus {

namespace {

// Clocks of cameras are off by less than a hundred millionths: half a millisecond within two of these.
constexpr Nanoseconds span = 2'500'000'000;

// No image is so late: the camera has set its clock.
constexpr Nanoseconds another_clock = 1'000'000'000;

// So that differences of stamps are numbers, too (unit: microseconds).
constexpr std::uint64_t latest_stamp = 4'000'000'000'000'000;

}  // namespace

Nanoseconds time_of_stamp(std::uint64_t stamp) {
    return static_cast<Nanoseconds>(std::min(stamp, latest_stamp)) * 1000;
}

Nanoseconds CameraClock::taken_at(std::uint64_t stamp, Nanoseconds arrived) {
    const Nanoseconds stamped = time_of_stamp(stamp);
    const Nanoseconds apart = arrived - stamped;
    const bool goes_on = is_known_ && stamped > last_;
    last_ = stamped;
    if (!goes_on || std::abs(apart - std::min(least_[0], least_[1])) > another_clock) {
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
