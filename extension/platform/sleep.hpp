// Sleeping to a point in time of monotonic_now().
//
// Threads: a timer belongs to the thread that sleeps with it.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

class SleepTimer {
public:
    SleepTimer();
    ~SleepTimer();
    SleepTimer(const SleepTimer&) = delete;
    SleepTimer& operator=(const SleepTimer&) = delete;

    // Ends late by what the system needs; may end early where the system's timer is coarser than its clock.
    void sleep_until(Nanoseconds deadline);

private:
    [[maybe_unused]] void* timer_ = nullptr;  // the system's, where it has such a thing
};

// How far before a deadline it may be worth waking up, since sleeps end that late here (unit: nanoseconds).
Nanoseconds usual_lateness();

}  // namespace tactus
