// When images were taken, on this machine's clock.
//
// A camera stamps its images on a clock of its own, and each arrives a while after it was taken, now sooner,
// now later. The least of (arrival - stamp) of late is what the clocks are apart, with the shortest way that
// an image takes: what that is, nobody but the camera's maker knows.
#pragma once

#include <array>
#include <cstdint>

#include "core/math/types.hpp"

namespace tactus {

// A stamp (unit: microseconds) as a time; one that no clock can show is the latest there is.
Nanoseconds time_of_stamp(std::uint64_t stamp);

class CameraClock {
public:
    // Of the image that was stamped so (unit: microseconds) and has arrived now: when it was taken, if the
    // shortest way takes no time. A stamp that is not later than the last one is another clock's: the camera
    // was set anew, or a recording has begun again.
    Nanoseconds taken_at(std::uint64_t stamp, Nanoseconds arrived);
    void forget() { *this = {}; }

private:
    // Clocks drift apart: what was least in the span before the last one is forgotten.
    std::array<Nanoseconds, 2> least_{};  // in this span, and in the one before
    Nanoseconds began_ = 0;               // this span
    Nanoseconds last_ = 0;                // stamp
    bool is_known_ = false;
};

}  // namespace tactus
