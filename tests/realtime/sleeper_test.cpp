// What can be said without asserting wall-clock time: it is never early, and learns within its limits.
#include "realtime/sleeper.hpp"

#include <gtest/gtest.h>

#include "platform/clock.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::sleeper_test {
namespace {

TEST(Sleeper, NeverReturnsBeforeTheDeadline) {
    for (const Nanoseconds spin_limit : {0, 50'000}) {
        Sleeper sleeper({spin_limit});
        for (int i = 0; i < 50; ++i) {
            const Nanoseconds deadline = monotonic_now() + 100'000;
            const Nanoseconds now = sleeper.wait_until(deadline);
            EXPECT_GE(now, deadline);
            EXPECT_LE(now, monotonic_now());
        }
    }
}

TEST(Sleeper, APassedDeadlineCostsNoSystemCall) {
    Sleeper sleeper({50'000});
    const Nanoseconds passed = monotonic_now() - 1'000;
    testing::AuditScope audit;
    sleeper.wait_until(passed);
    audit.finish();
    EXPECT_EQ(audit.system_calls(), 0u);
}

TEST(Sleeper, TheLookOutStaysWithinItsLimit) {
    constexpr Nanoseconds limit = 2'000;
    Sleeper sleeper({limit});
    for (int i = 0; i < 50; ++i) {
        sleeper.wait_until(monotonic_now() + 50'000);
        EXPECT_GE(sleeper.oversleep(), 0);
        EXPECT_LE(sleeper.oversleep(), limit);
    }
}

TEST(Sleeper, WithoutALookOutNothingIsLearnt) {
    Sleeper sleeper({0});
    sleeper.wait_until(monotonic_now() + 100'000);
    EXPECT_EQ(sleeper.oversleep(), 0);
}

}  // namespace
}  // namespace tactus::sleeper_test
