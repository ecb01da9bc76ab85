#include <time.h>

#include "platform/clock.hpp"

namespace tactus {

namespace {

Nanoseconds read_clock(clockid_t clock) {
    timespec now;
    clock_gettime(clock, &now);
    return static_cast<Nanoseconds>(now.tv_sec) * nanoseconds_per_second + now.tv_nsec;
}

}  // namespace

Nanoseconds monotonic_now() {
    return read_clock(CLOCK_MONOTONIC);
}

Nanoseconds wall_clock_now() {
    return read_clock(CLOCK_REALTIME);
}

Nanoseconds thread_time() {
    return read_clock(CLOCK_THREAD_CPUTIME_ID);
}

}  // namespace tactus
