// The judge of ./run bench device --displayed: which cuts of a force have no good reason.
#include "shared/even_ticks.hpp"

#include <gtest/gtest.h>

namespace tactus::even_ticks_test {
namespace {

using shared::EvenTicks, shared::TickTimes;

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds us = 1'000;

// A loop of 1 kHz whose ticks write for 10 us.
struct Judged {
    EvenTicks even{ms};
    Nanoseconds begin = 1'000 * ms;

    bool tick(Nanoseconds late = 0, Nanoseconds writing = 10 * us, Nanoseconds counting = us,
              bool stood_still = false) {
        begin += ms;
        const Nanoseconds writes = begin + late;
        return even.add({writes, writes + writing, writes + writing + counting}, stood_still);
    }
    int ticks_until_even() {
        int ticks = 1;
        while (!tick() && ticks < 100) {
            ++ticks;
        }
        return ticks;
    }
};

TEST(EvenTicks, ALoopIsJudgedTenTicksAfterItHasBegun) {
    Judged judged;
    EXPECT_EQ(judged.ticks_until_even(), 12) << "the first one follows none";
    for (int i = 0; i < 100; ++i) {
        EXPECT_TRUE(judged.tick(i % 7 * 50 * us)) << "late by less than a force outlives its tick";
    }
}

TEST(EvenTicks, NoneIsJudgedWithinTenTicksOfALateOneOrAStall) {
    Judged judged;
    judged.ticks_until_even();
    EXPECT_FALSE(judged.tick(ms / 2));
    EXPECT_EQ(judged.ticks_until_even(), 11);
    EXPECT_FALSE(judged.tick(0, 10 * us, us, true));
    EXPECT_EQ(judged.ticks_until_even(), 11);
}

// The cut was counted in the tick before the late one, which had been found even before the pause.
TEST(EvenTicks, ACutThatIsCountedAfterAPauseBehindTheWriteIsRight) {
    Judged judged;
    judged.ticks_until_even();
    EXPECT_FALSE(judged.tick(0, 10 * us, 16 * ms / 10));
    EXPECT_FALSE(judged.tick(8 * ms / 10)) << "the next one is late by the same pause";
}

// A force is as old as the begin of its writing.
TEST(EvenTicks, AForceThatIsWrittenForLongIsShorterOnItsWay) {
    Judged judged;
    judged.ticks_until_even();
    EXPECT_TRUE(judged.tick(0, 350 * us));
    EXPECT_FALSE(judged.tick(ms / 2)) << "1.5 ms after the last one began, and 1.15 ms after it ended";
}

TEST(EvenTicks, ASlowLoopMayBeLateByATenthOfItsPeriod) {
    EvenTicks even(16 * ms / 10);
    Nanoseconds now = 1'000 * ms;
    bool is_even = false;
    for (int i = 0; i < 20; ++i) {
        now += 17 * ms / 10;
        is_even = even.add({now, now + us, now + 2 * us}, false);
    }
    EXPECT_TRUE(is_even);
    now += 18 * ms / 10;
    EXPECT_FALSE(even.add({now, now + us, now + 2 * us}, false));
}

}  // namespace
}  // namespace tactus::even_ticks_test
