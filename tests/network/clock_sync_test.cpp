// Two clocks, a network between them, and what is found out about the one from the other.
#include "network/clock_sync.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "network/link_conditions.hpp"
#include "shared/random_values.hpp"

namespace tactus::clock_sync_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds us = 1'000;

// One exchange that starts at `t0` (true time, which is this side's clock) and takes the given ways.
ClockExchange exchange(const ClockSkew& far, Nanoseconds t0, Nanoseconds forth, Nanoseconds back) {
    const Nanoseconds thinking = 200 * us;
    return {t0, t0 + forth + thinking + back, far.shown_at(t0 + forth), far.shown_at(t0 + forth + thinking)};
}

TEST(ClockSync, KnowsNothingAtFirst) {
    const ClockSync sync;
    EXPECT_FALSE(sync.figures().known);
    EXPECT_EQ(sync.far_time(5), 5);
    EXPECT_EQ(sync.near_time(5), 5);
}

TEST(ClockSync, EvenDelaysGiveTheOffsetExactly) {
    ClockSync sync;
    const ClockSkew far{0, 123'456'789, 0.0};
    for (int i = 0; i < 300; ++i) {
        ASSERT_TRUE(sync.add(exchange(far, i * 100 * ms, 50 * ms, 50 * ms)));
        EXPECT_EQ(sync.figures().offset, 123'456'789);
    }
    EXPECT_EQ(sync.figures().drift, 0.0);
    EXPECT_EQ(sync.figures().least_delay, 100 * ms);
    EXPECT_EQ(sync.figures().uncertainty, 50 * ms);
    EXPECT_EQ(sync.figures().jitter, 0.0);
    EXPECT_EQ(sync.figures().jumps, 0u);
    EXPECT_EQ(sync.far_time(1000), 123'457'789);
    EXPECT_EQ(sync.near_time(123'457'789), 1000);
}

TEST(ClockSync, TheErrorIsAtMostHalfTheDelay) {
    ClockSync sync;
    const ClockSkew far{0, -7 * ms, 0.0};
    sync.add(exchange(far, 0, 30 * ms, 10 * ms));
    EXPECT_EQ(sync.figures().offset, -7 * ms + 10 * ms);
    EXPECT_LE(std::abs(sync.figures().offset + 7 * ms), sync.figures().uncertainty);
}

// However uneven the delays and whatever the drift, at each exchange and until the next one.
TEST(ClockSync, TheOffsetIsRightToWithinWhatIsSaid) {
    struct Ways {
        double forth, back, jitter;  // (unit: milliseconds)
    };
    for (const Ways& ways : {Ways{100, 0, 0}, Ways{0, 100, 0}, Ways{50, 50, 20}, Ways{100, 0, 20},
                             Ways{0, 40, 30}, Ways{5, 300, 100}, Ways{300, 1, 3}, Ways{1, 0, 0.5}}) {
        for (const double drift : {-1e-3, -100e-6, 0.0, 20e-6, 500e-6}) {
            ClockSync sync;
            const ClockSkew far{0, 300 * ms, drift};
            shared::RandomValues random(3);
            const auto late = [&] { return ways.jitter * random.unit() * random.unit(); };
            for (int i = 0; i < 600; ++i) {
                const Nanoseconds start = (1000 + i * 200) * ms;
                const auto forth = static_cast<Nanoseconds>((ways.forth + late()) * ms);
                const auto back = static_cast<Nanoseconds>((ways.back + late()) * ms);
                const ClockExchange made = exchange(far, start, forth, back);
                ASSERT_TRUE(sync.add(made));
                for (const Nanoseconds later : {Nanoseconds{0}, 100 * ms, 199 * ms}) {
                    const Nanoseconds now = made.t3 + later;
                    const ClockFigures figures = sync.figures_at(now);
                    ASSERT_LE(std::abs(now + figures.offset - far.shown_at(now)), figures.uncertainty + 10)
                        << ways.forth << ' ' << ways.back << ' ' << ways.jitter << ' ' << drift << ' ' << i;
                }
            }
            EXPECT_EQ(sync.figures().jumps, 0u);
            // It is no excuse either: both ends of what is possible are that far apart.
            EXPECT_LT(sync.figures().uncertainty, sync.figures().least_delay + 3 * ms) << drift;
        }
    }
}

TEST(ClockSync, TheLeastDelayIsBelievedAgainstAHundredSlowOnes) {
    ClockSync sync;
    const ClockSkew far{0, 5 * ms, 0.0};
    shared::RandomValues random(1);
    const auto late = [&] { return static_cast<Nanoseconds>(random.between(5.0, 40.0) * ms); };
    for (int i = 0; i < 100; ++i) {
        sync.add(exchange(far, i * 10 * ms, 10 * ms + late(), 10 * ms + late()));
    }
    sync.add(exchange(far, 1000 * ms, 10 * ms, 10 * ms));
    EXPECT_NEAR(static_cast<double>(sync.figures().offset), 5.0 * ms, 0.5 * ms);
    EXPECT_EQ(sync.figures().least_delay, 20 * ms);
}

TEST(ClockSync, FindsTheDriftThroughJitter) {
    for (const double drift : {-200e-6, -20e-6, 0.0, 50e-6, 500e-6}) {
        ClockSync sync;
        const ClockSkew far{0, 1'000 * ms, drift};
        shared::RandomValues random(2);
        Nanoseconds now = 0;
        for (int i = 0; i < 300; ++i) {
            now += 100 * ms;
            const auto way = [&] {
                return 20 * ms + static_cast<Nanoseconds>(ms * 3.0 * random.unit() * random.unit());
            };
            ASSERT_TRUE(sync.add(exchange(far, now, way(), way())));
        }
        EXPECT_NEAR(sync.figures().drift, drift, 30e-6);
        EXPECT_NEAR(static_cast<double>(sync.far_time(now)), static_cast<double>(far.shown_at(now)),
                    0.25 * ms);
        EXPECT_EQ(sync.figures().jumps, 0u) << drift;
    }
}

TEST(ClockSync, ThereAndBackIsTheSameTime) {
    ClockSync sync;
    const ClockSkew far{0, 77 * ms, 90e-6};
    for (int i = 0; i < 100; ++i) {
        sync.add(exchange(far, i * 200 * ms, 3 * ms, 3 * ms));
    }
    for (Nanoseconds here = 0; here < 60'000 * ms; here += 777 * ms) {
        EXPECT_NEAR(static_cast<double>(sync.near_time(sync.far_time(here)) - here), 0.0, 1.0);
    }
}

TEST(ClockSync, SeesAClockThatWasSetAndStartsAnew) {
    for (const Nanoseconds jump : {-3'600'000 * ms, -200 * ms, 150 * ms, 3'600'000 * ms}) {
        ClockSync sync;
        for (int i = 0; i < 100; ++i) {
            sync.add(exchange({0, 10 * ms, 0.0}, i * 100 * ms, 50 * ms, 50 * ms));
        }
        ASSERT_EQ(sync.figures().jumps, 0u);
        sync.add(exchange({0, 10 * ms + jump, 0.0}, 10'100 * ms, 50 * ms, 50 * ms));
        EXPECT_EQ(sync.figures().jumps, 1u) << jump;
        EXPECT_EQ(sync.figures().offset, 10 * ms + jump);
    }
}

TEST(ClockSync, AnOwnClockThatIsSetBackIsSeenToo) {
    ClockSync sync;
    for (int i = 0; i < 100; ++i) {
        sync.add(exchange({}, i * 100 * ms, ms, ms));
    }
    sync.add(exchange({}, 500 * ms, ms, ms));
    EXPECT_EQ(sync.figures().jumps, 1u);
    EXPECT_EQ(sync.figures().offset, 0);
}

TEST(ClockSync, ADelayThatGrowsIsNoJump) {
    ClockSync sync;
    for (int i = 0; i < 600; ++i) {
        const Nanoseconds way = i < 300 ? 5 * ms : 250 * ms;
        sync.add(exchange({0, 3 * ms, 0.0}, i * 100 * ms, way, 10 * ms));
    }
    EXPECT_EQ(sync.figures().jumps, 0u);
    EXPECT_EQ(sync.figures().least_delay, 260 * ms) << "the old delay is forgotten";
}

TEST(ClockSync, RefusesWhatNoClocksCanHaveMade) {
    ClockSync sync;
    EXPECT_FALSE(sync.add({10, 5, 0, 0})) << "answered before it was asked";
    EXPECT_FALSE(sync.add({0, 10, 20, 15})) << "left before it came";
    EXPECT_FALSE(sync.add({0, 10, 0, 20})) << "thought longer than it was away";
    EXPECT_EQ(sync.figures().refused, 3u);
    EXPECT_FALSE(sync.figures().known);
}

TEST(ClockSync, JitterIsTheMeanChangeOfDelay) {
    ClockSync sync;
    for (int i = 0; i < 500; ++i) {
        sync.add(exchange({}, i * 10 * ms, 10 * ms + (i % 2) * 4 * ms, 10 * ms));
    }
    EXPECT_NEAR(sync.figures().jitter, 4.0 * ms, 1.0);
    EXPECT_NEAR(sync.figures().mean_delay, 22.0 * ms, 0.2 * ms);
}

TEST(ClockSync, ForgetsOnRequest) {
    ClockSync sync;
    sync.add(exchange({0, 5 * ms, 0.0}, 0, ms, ms));
    sync.forget();
    EXPECT_FALSE(sync.figures().known);
    EXPECT_EQ(sync.far_time(9), 9);
    sync.add(exchange({0, 900 * ms, 0.0}, 0, ms, ms));
    EXPECT_EQ(sync.figures().jumps, 0u);
}

}  // namespace
}  // namespace tactus::clock_sync_test
