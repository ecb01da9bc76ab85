#include "platform/sleep.hpp"

#include <gtest/gtest.h>

namespace tactus::sleep_test {
namespace {

TEST(SleepTimer, ADeadlineBeforeTheClockBeganIsOver) {
    SleepTimer timer;
    for (const Nanoseconds deadline : {Nanoseconds{0}, Nanoseconds{-1}, Nanoseconds{-200'000}}) {
        timer.sleep_until(deadline);
    }
}

}  // namespace
}  // namespace tactus::sleep_test
