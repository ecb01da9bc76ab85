#include "platform/clock.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace tactus::clock_test {
namespace {

TEST(Clock, NeverGoesBackAndIsFinerThanTenMicroseconds) {
    Nanoseconds last = monotonic_now();
    Nanoseconds least = nanoseconds_per_second;
    for (int i = 0; i < 100'000; ++i) {
        const Nanoseconds now = monotonic_now();
        ASSERT_GE(now, last);
        least = now > last ? std::min(least, now - last) : least;
        last = now;
    }
    EXPECT_LT(least, 10'000);
}

TEST(Clock, TheWallClockIsTheSystems) {
    using namespace std::chrono;
    const auto as_nanoseconds = [](system_clock::time_point time) {
        return duration_cast<nanoseconds>(time.time_since_epoch()).count();
    };
    const Nanoseconds before = as_nanoseconds(system_clock::now());
    const Nanoseconds now = wall_clock_now();
    const Nanoseconds after = as_nanoseconds(system_clock::now());
    // The system may answer in coarser steps by one way than by the other.
    EXPECT_GE(now, before - 20'000'000);
    EXPECT_LE(now, after + 20'000'000);
}

}  // namespace
}  // namespace tactus::clock_test
