// A driver at work in a test, in real time: ticks, and waiting for what a thread of its own does. Nobody
// looks at how long that takes.
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "devices/driver_device.hpp"
#include "platform/clock.hpp"
#include "platform/sleep.hpp"

namespace tactus {

constexpr Nanoseconds one_tick = 1'000'000;
constexpr Nanoseconds longest_wait = 20'000 * one_tick;

inline bool tick_until(DriverDevice& device, const Vec3& force,
                       const std::function<bool(const DeviceSample&)>& done) {
    SleepTimer timer;
    for (const Nanoseconds end = monotonic_now() + longest_wait; monotonic_now() < end;) {
        const Nanoseconds now = monotonic_now();
        const DeviceSample sample = device.read(now);
        if (done(sample)) {
            return true;
        }
        device.write(now, force);
        timer.sleep_until(now + one_tick);
    }
    ADD_FAILURE() << "it says: " << device.health().text;
    return false;
}

inline bool wait_until(const std::function<bool()>& done) {
    SleepTimer timer;
    for (const Nanoseconds end = monotonic_now() + longest_wait; monotonic_now() < end && !done();) {
        timer.sleep_until(monotonic_now() + one_tick);
    }
    return done();
}

}  // namespace tactus
