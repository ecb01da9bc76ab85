// The one clock of the haptic side: steady, in nanoseconds, never set back. Only realtime/ and what stands at
// the edge of the program read it; core/, physics/ and session/ are handed the time.
#pragma once

#include <time.h>

#include "core/math/types.hpp"

namespace tactus {

inline timespec to_timespec(Nanoseconds time) {
    return {static_cast<time_t>(time / nanoseconds_per_second),
            static_cast<long>(time % nanoseconds_per_second)};
}

// CLOCK_MONOTONIC: read through the vDSO, no system call. It stands still while the machine is suspended.
inline Nanoseconds monotonic_now() {
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<Nanoseconds>(now.tv_sec) * nanoseconds_per_second + now.tv_nsec;
}

}  // namespace tactus
