// Keeps a thread that works in bursts off the processor that a haptic loop prefers, so that the loop finds
// its caches as it left them: beside a sensor that looks 30 times a second the slowest hundredth of the
// ticks took 1.19 times as long, and 1.13 times where it keeps off (bench `sensing`, 18 rounds each).
//
// Only as long as the other processors have time: a thread that mostly waits there comes back for a while.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

// Whether the next burst keeps off, told from how the last ones went.
class CrowdedOut {
public:
    // `worked` (processor time) of the `lasted` that a burst took, both > 0 (unit: nanoseconds).
    void burst(Nanoseconds worked, Nanoseconds lasted);
    bool keeps_off() const { return bursts_back_ == 0; }

private:
    static constexpr int judged = 10;      // bursts together: Windows counts processor time in steps of 16 ms
    static constexpr int turn_back = 300;  // bursts; a camera's ten seconds
    int bursts_ = 0, bursts_back_ = 0;     // of those judged next; left to be on any processor
    Nanoseconds worked_ = 0, lasted_ = 0;  // by those judged next
};

// Used by one thread, the one that works.
class BesideLoop {
public:
    void begin_burst();
    void end_burst();

private:
    CrowdedOut crowded_;
    bool is_off_ = false;
    Nanoseconds worked_before_ = 0, began_ = 0;
};

}  // namespace tactus
