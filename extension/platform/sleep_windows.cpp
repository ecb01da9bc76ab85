#include "platform/clock.hpp"
#include "platform/sleep.hpp"
#include "platform/waitable_timer_windows.hpp"

namespace tactus {

SleepTimer::SleepTimer() : timer_(windows::open_timer()) {}

SleepTimer::~SleepTimer() {
    if (timer_ != nullptr) {
        CloseHandle(timer_);
    }
}

// Relative: the absolute times of these timers are those of the wall clock, which may be set.
void SleepTimer::sleep_until(Nanoseconds deadline) {
    const Nanoseconds left = deadline - monotonic_now();
    if (left <= 0) {
        return;
    }
    if (timer_ == nullptr) {
        Sleep(static_cast<DWORD>(left / 1'000'000));
        return;
    }
    windows::arm(timer_, left);
    WaitForSingleObject(timer_, INFINITE);
}

// Timers of high resolution go off in steps of half a millisecond.
Nanoseconds usual_lateness() {
    return 600'000;
}

}  // namespace tactus
