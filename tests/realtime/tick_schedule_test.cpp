#include "realtime/tick_schedule.hpp"

#include <gtest/gtest.h>

namespace tactus::tick_schedule_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;

TEST(TickSchedule, DeadlinesAreMultiplesOfThePeriodFromTheStart) {
    TickSchedule schedule(100, ms, 1000 * ms);
    for (Nanoseconds k = 0; k < 1000; ++k) {
        ASSERT_EQ(schedule.deadline(), 100 + k * ms);
        schedule.advance();
    }
}

// Thesis 4.4.4: after a stall the following ticks come sooner until the mean is one period again.
TEST(TickSchedule, AStallIsCaughtUpAndTheMeanStaysOnePeriod) {
    constexpr Nanoseconds work = 50'000;
    TickSchedule schedule(0, ms, 1000 * ms);
    Nanoseconds now = 0;
    Nanoseconds last_start = 0;
    for (int k = 0; k <= 1000; ++k) {
        now = now < schedule.deadline() ? schedule.deadline() : now;
        EXPECT_EQ(schedule.rebase_if_hopeless(now), 0);
        last_start = now;
        schedule.advance();
        now += k == 500 ? 20 * ms : work;
    }
    EXPECT_EQ(last_start, 1000 * ms);
}

TEST(TickSchedule, ATickAsLateAsAllowedIsStillCaughtUp) {
    TickSchedule schedule(0, ms, 100 * ms);
    EXPECT_EQ(schedule.rebase_if_hopeless(100 * ms), 0);
    EXPECT_EQ(schedule.deadline(), 0);
}

TEST(TickSchedule, AHopelessDelayMovesTheScheduleAndSaysHowFar) {
    TickSchedule schedule(0, ms, 100 * ms);
    EXPECT_EQ(schedule.rebase_if_hopeless(250 * ms), 250 * ms);
    EXPECT_EQ(schedule.deadline(), 250 * ms);
    schedule.advance();
    EXPECT_EQ(schedule.deadline(), 251 * ms);
}

TEST(TickSchedule, BeingEarlyChangesNothing) {
    TickSchedule schedule(500, ms, 100 * ms);
    EXPECT_EQ(schedule.rebase_if_hopeless(0), 0);
    EXPECT_EQ(schedule.deadline(), 500);
}

}  // namespace
}  // namespace tactus::tick_schedule_test
