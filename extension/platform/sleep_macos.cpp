#include <mach/mach_time.h>

#include "platform/clock.hpp"
#include "platform/sleep.hpp"

namespace tactus {

namespace {

std::uint64_t wait_units(Nanoseconds span) {
    static const mach_timebase_info_data_t base = [] {
        mach_timebase_info_data_t read{};
        mach_timebase_info(&read);
        return read;
    }();
    return static_cast<std::uint64_t>(span) * base.denom / base.numer;
}

}  // namespace

SleepTimer::SleepTimer() = default;
SleepTimer::~SleepTimer() = default;

// Mach's clock stands still in a suspended machine, CLOCK_MONOTONIC does not there: only the span is handed
// on.
void SleepTimer::sleep_until(Nanoseconds deadline) {
    const Nanoseconds left = deadline - monotonic_now();
    if (left > 0) {
        mach_wait_until(mach_absolute_time() + wait_units(left));
    }
}

Nanoseconds usual_lateness() {
    return 100'000;
}

}  // namespace tactus
