#include "platform/waitable_timer_windows.hpp"

#include <timeapi.h>

#include <algorithm>

namespace tactus::windows {

HANDLE open_timer() {
    constexpr DWORD high_resolution = 0x2;  // CREATE_WAITABLE_TIMER_HIGH_RESOLUTION; older headers lack it
    HANDLE timer = CreateWaitableTimerExW(nullptr, nullptr, high_resolution, TIMER_ALL_ACCESS);
    if (timer == nullptr) {
        timeBeginPeriod(1);
        timer = CreateWaitableTimerExW(nullptr, nullptr, 0, TIMER_ALL_ACCESS);
    }
    return timer;
}

void arm(HANDLE timer, Nanoseconds span) {
    LARGE_INTEGER due;
    due.QuadPart = -std::max<Nanoseconds>(span / 100, 1);  // below zero: from now on, in 100 ns
    SetWaitableTimer(timer, &due, 0, nullptr, nullptr, FALSE);
}

}  // namespace tactus::windows
