// Which image of a recording is to be shown when, by the times at which its images were taken.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

class Playback {
public:
    struct Choice {
        bool repeats = true;           // at the end it begins again
        bool as_fast_as_read = false;  // drops no image and waits for none
    };

    // `times` by the camera's clock, not empty (unit: microseconds). They may go back or stand still.
    Playback(std::vector<std::uint64_t> times, const Choice& choice);

    // The image to be shown at `now`, by any steady clock: the last one whose time has come, those before it
    // are dropped. None: its time has not come, or the recording is at its end.
    std::optional<std::size_t> next(Nanoseconds now);
    // When the next image's time comes; as of the last next().
    Nanoseconds due() const { return due_; }
    bool has_ended() const { return next_ == times_.size(); }

private:
    void go_on();
    Nanoseconds gap(std::size_t before, std::size_t after) const;

    std::vector<std::uint64_t> times_;
    Choice choice_;
    bool has_begun_ = false;
    std::size_t next_ = 0;
    Nanoseconds due_ = 0;
};

}  // namespace tactus
