#include <time.h>

#include <cerrno>

#include "platform/sleep.hpp"

namespace tactus {

SleepTimer::SleepTimer() = default;
SleepTimer::~SleepTimer() = default;

void SleepTimer::sleep_until(Nanoseconds deadline) {
    if (deadline <= 0) {
        return;  // the kernel takes no time below zero
    }
    const timespec until{static_cast<time_t>(deadline / nanoseconds_per_second),
                         static_cast<long>(deadline % nanoseconds_per_second)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
}

Nanoseconds usual_lateness() {
    return 30'000;
}

}  // namespace tactus
