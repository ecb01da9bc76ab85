// The one clock of the haptic side: steady, in nanoseconds, never set back. Only realtime/ and what stands at
// the edge of the program read it; core/, physics/ and session/ are handed the time.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

// No system call where the system has a way around one. It may stand still while the machine is suspended.
Nanoseconds monotonic_now();

// Since the epoch, as this machine's clock is set.
Nanoseconds wall_clock_now();

// Processor time that the calling thread has taken.
Nanoseconds thread_time();

}  // namespace tactus
