#include <windows.h>

#include "platform/clock.hpp"

namespace tactus {

namespace {

// In steps of 100 ns.
std::int64_t steps_of(const FILETIME& time) {
    return static_cast<std::int64_t>(time.dwHighDateTime) << 32 | time.dwLowDateTime;
}

// Constant from the start of the system on.
std::int64_t counts_per_second() {
    LARGE_INTEGER frequency;
    QueryPerformanceFrequency(&frequency);
    return frequency.QuadPart;
}

}  // namespace

// Whole seconds apart from the rest: the product would overflow after 15 minutes at 10 MHz.
Nanoseconds monotonic_now() {
    static const std::int64_t frequency = counts_per_second();
    LARGE_INTEGER counter;
    QueryPerformanceCounter(&counter);
    return counter.QuadPart / frequency * nanoseconds_per_second +
           counter.QuadPart % frequency * nanoseconds_per_second / frequency;
}

Nanoseconds wall_clock_now() {
    constexpr std::int64_t epoch = 116'444'736'000'000'000;  // 1970 in 100 ns since 1601
    FILETIME time;
    GetSystemTimePreciseAsFileTime(&time);
    return (steps_of(time) - epoch) * 100;
}

Nanoseconds thread_time() {
    FILETIME created, ended, kernel, user;
    GetThreadTimes(GetCurrentThread(), &created, &ended, &kernel, &user);
    return 100 * (steps_of(kernel) + steps_of(user));
}

}  // namespace tactus
