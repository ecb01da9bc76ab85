#include "core/safety/force_watch.hpp"

#include <cmath>
#include <cstdio>

namespace tactus {

std::string why_no_force(const LoopPace& pace) {
    if (!pace.is_real_time) {
        return "a device gives no force in stepped time, in which the loop cannot renew it within 2 ms: set "
               "the world's 'clock' to real time";
    }
    if (pace.period <= slowest_tick) {
        return {};
    }
    char text[160];
    std::snprintf(text, sizeof text,
                  "a device gives no force at %.0f ticks a second, since the hand has to be free 2 ms after "
                  "the last one: set the world's 'tick_rate' to %.0f or more",
                  1.0 / to_seconds(pace.period), std::ceil(1.0 / to_seconds(slowest_tick)));
    return text;
}

const char* text_of(ForceCut cut) {
    switch (cut) {
        case ForceCut::loop_silent:
            return "a tick of the haptic loop was late";
        case ForceCut::device_silent:
            return "the device sent no reading in time";
        case ForceCut::driver_stuck:
            return "the device's library or bus did not answer in time";
    }
    return "";
}

}  // namespace tactus
