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

class CameraClock {
public:
    // Of the image that was stamped so (unit: microseconds) and has arrived now: when it was taken, if the
    // shortest way takes no time.
    Nanoseconds taken_at(std::uint64_t stamp, Nanoseconds arrived);
    void forget() { *this = {}; }

private:
    // Clocks drift apart: what was least in the span before the last one is forgotten.
    std::array<Nanoseconds, 2> least_{};  // in this span, and in the one before
    Nanoseconds began_ = 0;               // this span
    bool is_known_ = false;
};

}  // namespace tactus
