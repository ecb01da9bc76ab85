#include "core/teleop/jitter_buffer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <glm/geometric.hpp>

#include "shared/random_values.hpp"

namespace tactus::jitter_buffer_test {
namespace {

struct Sample {
    std::uint64_t sequence = 0;
    Vec3 position{0.0};
    Vec3 velocity{0.0};
};

constexpr double hand_speed = 0.2;  // (unit: meters per second)

// The hand after so many samples of `seconds`: to and fro along x, 0.1 m either way.
Sample sample(double sequence, double seconds = 0.001) {
    constexpr double reach = 0.1;
    const double phase = hand_speed / reach * seconds * sequence;
    return {static_cast<std::uint64_t>(sequence),
            {reach * std::sin(phase), 0.0, 0.0},
            {hand_speed * std::cos(phase), 0.0, 0.0}};
}

using Buffer = JitterBuffer<Sample>;

JitterBufferSettings sparse() {
    JitterBufferSettings settings;
    settings.sparse = true;
    return settings;
}

// A perfect link from the buffer's first tick on: the sample of a tick is there in it.
void run(Buffer& buffer, std::uint64_t first, std::uint64_t last, Sample& out) {
    for (std::uint64_t sequence = first; sequence <= last; ++sequence) {
        buffer.insert(sample(static_cast<double>(sequence)));
        buffer.play(out);
    }
}

TEST(JitterBuffer, WaitsUntilSomethingComes) {
    Buffer buffer;
    Sample out;
    EXPECT_EQ(buffer.play(out), Playing::waiting);
}

TEST(JitterBuffer, PlaysInOrderWhatComesOutOfOrder) {
    JitterBufferSettings settings;
    settings.depth = 2;
    Buffer buffer(settings);
    for (const double sequence : {2.0, 1.0, 3.0}) {
        buffer.insert(sample(sequence));
    }
    for (std::uint64_t sequence = 1; sequence <= 3; ++sequence) {
        Sample out;
        ASSERT_EQ(buffer.play(out), Playing::exact);
        EXPECT_EQ(out.sequence, sequence);
    }
}

TEST(JitterBuffer, KeepsItsDepth) {
    JitterBufferSettings settings;
    settings.depth = 3;
    Buffer buffer(settings);
    Sample out;
    for (int sequence = 1; sequence <= 3; ++sequence) {
        buffer.insert(sample(sequence));
        EXPECT_EQ(buffer.play(out), Playing::waiting);
    }
    for (std::uint64_t sequence = 4; sequence <= 20'000; ++sequence) {
        buffer.insert(sample(static_cast<double>(sequence)));
        ASSERT_EQ(buffer.play(out), Playing::exact);
        ASSERT_EQ(out.sequence, sequence - 3);
    }
}

TEST(JitterBuffer, PlaysTheNewestAtOnceWhereThatIsAsked) {
    JitterBufferSettings settings;
    settings.newest = true;
    Buffer buffer(settings);
    Sample out;
    const auto expect = [&](Playing how, std::uint64_t sequence) {
        EXPECT_EQ(buffer.play(out), how);
        EXPECT_EQ(out.sequence, sequence);
    };
    buffer.insert(sample(1));
    expect(Playing::exact, 1);
    buffer.insert(sample(4));  // none is filled in
    expect(Playing::exact, 4);
    buffer.insert(sample(3));  // too late
    expect(Playing::held, 4);
    for (const double sequence : {5.0, 7.0, 6.0, 9.0}) {
        buffer.insert(sample(sequence));
    }
    expect(Playing::exact, 9);
    for (std::uint64_t sequence = 10; sequence < 500; ++sequence) {  // and no lag is kept after the stall
        buffer.insert(sample(static_cast<double>(sequence)));
        expect(Playing::exact, sequence);
    }
}

TEST(JitterBuffer, FillsALossBetweenItsNeighbours) {
    JitterBufferSettings settings;
    settings.depth = 3;
    Buffer buffer(settings);
    Sample out;
    for (const double sequence : {1.0, 4.0}) {
        buffer.insert(sample(sequence));
    }
    ASSERT_EQ(buffer.play(out), Playing::exact);
    const Vec3 way = sample(4).position - sample(1).position;
    ASSERT_EQ(buffer.play(out), Playing::filled);
    EXPECT_EQ(out.sequence, 2u);
    EXPECT_NEAR(out.position.x, sample(1).position.x + way.x / 3.0, 1e-15);
    ASSERT_EQ(buffer.play(out), Playing::filled);
    EXPECT_EQ(out.sequence, 3u);
    EXPECT_EQ(buffer.play(out), Playing::exact);
    EXPECT_EQ(out.sequence, 4u);
}

TEST(JitterBuffer, HoldsTheLastOneWhenItIsDry) {
    Buffer buffer;
    Sample out;
    buffer.insert(sample(1));
    buffer.play(out);
    EXPECT_EQ(buffer.play(out), Playing::held);
    EXPECT_EQ(out.sequence, 1u);
    buffer.insert(sample(2));
    EXPECT_EQ(buffer.play(out), Playing::exact);
    EXPECT_EQ(out.sequence, 2u);
}

TEST(JitterBuffer, WhatIsHeldForLongDoesNotMove) {
    Buffer buffer;
    Sample out;
    run(buffer, 1, 100, out);
    EXPECT_NE(out.velocity, Vec3(0.0));
    for (int i = 0; i < 50; ++i) {
        buffer.play(out);
    }
    EXPECT_EQ(out.velocity, Vec3(0.0));
}

TEST(JitterBuffer, CountsWhatComesTwiceOrLate) {
    Buffer buffer;
    Sample out;
    buffer.insert(sample(2));
    buffer.insert(sample(2));
    buffer.play(out);
    buffer.insert(sample(1));
    EXPECT_EQ(buffer.counts().doubled, 1u);
    EXPECT_EQ(buffer.counts().late, 1u);
}

// The first packet brings older samples along: they are no reason to stay behind.
TEST(JitterBuffer, APerfectLinkLosesNothingAndWaitsForNothing) {
    Buffer buffer;
    Sample out;
    for (int sequence = 1; sequence <= 9; ++sequence) {
        buffer.insert(sample(sequence));
    }
    for (std::uint64_t sequence = 10; sequence < 30'000; ++sequence) {
        for (std::uint64_t repeated = sequence - 8; repeated <= sequence; ++repeated) {
            buffer.insert(sample(static_cast<double>(repeated)));
        }
        ASSERT_EQ(buffer.play(out), Playing::exact);
        ASSERT_EQ(out.sequence, sequence);
    }
    EXPECT_EQ(buffer.counts().catch_ups, 0u);
}

// --- what cannot be

TEST(JitterBuffer, NoNumberStopsIt) {
    for (const std::uint64_t far :
         {std::uint64_t{100}, std::uint64_t{513}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
        for (const bool is_sparse : {false, true}) {
            Buffer buffer(is_sparse ? sparse() : JitterBufferSettings{});
            Sample out;
            run(buffer, 1, 1000, out);
            Sample jump = sample(1000);
            jump.sequence = far < 1000 ? out.sequence + far : far;
            jump.position = {7.0, 7.0, 7.0};
            for (const Sample& one : {jump, jump}) {
                buffer.insert(one);
                buffer.play(out);
            }
            const Vec3 before = out.position;
            EXPECT_LT(glm::distance(before, sample(1000).position), 0.0021);
            run(buffer, 1003, 5000, out);
            EXPECT_EQ(out.sequence, 5000u);
            EXPECT_NEAR(out.position.x, sample(5000).position.x, 1e-12);
        }
    }
}

TEST(JitterBuffer, NumbersThatRunAroundTheRingDoNotStopIt) {
    Buffer buffer;
    Sample out;
    run(buffer, 1, 100, out);
    for (const std::uint64_t sequence : {612u, 613u, 1125u, 101u}) {
        buffer.insert({sequence, Vec3(0.0), Vec3(0.0)});
    }
    for (int i = 0; i < 3000; ++i) {
        buffer.play(out);
    }
    EXPECT_GT(buffer.counts().implausible + buffer.counts().held, 0u);
}

// Whoever began with a number that cannot be does not keep the true sequence out.
TEST(JitterBuffer, AFirstNumberThatWasWrongIsForgotten) {
    for (const std::uint64_t first : {std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
        Buffer buffer;
        Sample out;
        buffer.insert({first, Vec3(3.0), Vec3(0.0)});
        buffer.play(out);
        run(buffer, 1, 300, out);
        EXPECT_EQ(out.sequence, 300u);
    }
}

TEST(JitterBuffer, RandomNumbersLeaveItUsable) {
    shared::RandomValues random(5);
    Buffer buffer;
    Sample out;
    for (int i = 0; i < 200'000; ++i) {
        const auto bits = static_cast<unsigned>(random.below(64));
        Sample wild = sample(1);
        wild.sequence = (static_cast<std::uint64_t>(random.below(1 << 30)) * 0x9e3779b97f4a7c15u) >> bits;
        buffer.insert(wild);
        if (i % 3 == 0) {
            buffer.play(out);
        }
    }
    run(buffer, 1'000'000, 1'001'000, out);
    EXPECT_EQ(out.sequence, 1'001'000u);
}

// --- outages and jitter

// Plays what `way` delivers: the delay in ticks of the sample of each tick, or negative: lost.
struct Played {
    std::vector<double> lag;   // how far behind the newest sample that a delay of 0 would have brought
    std::vector<double> step;  // of the hand (unit: meters)
    BufferCounts counts;
};

template <typename Way>
Played play(int ticks, Way&& way, JitterBufferSettings settings = {}, int in_a_packet = 3) {
    Buffer buffer(settings);
    std::vector<std::vector<int>> due(static_cast<std::size_t>(ticks) + 20'000);
    Played played;
    Sample out;
    Vec3 last(0.0);
    bool any = false;
    for (int t = 0; t < ticks; ++t) {
        if (const int delay = way(t); delay >= 0) {
            due[static_cast<std::size_t>(t + delay)].push_back(t + 1);
        }
        for (const int sequence : due[static_cast<std::size_t>(t)]) {
            for (int repeated = std::max(1, sequence + 1 - in_a_packet); repeated <= sequence; ++repeated) {
                buffer.insert(sample(repeated));
            }
        }
        const bool waits = buffer.play(out) == Playing::waiting;
        played.lag.push_back(waits ? 1e9 : t + 1 - static_cast<double>(out.sequence));
        played.step.push_back(any && !waits ? glm::distance(out.position, last) : 0.0);
        any = any || !waits;
        last = out.position;
    }
    played.counts = buffer.counts();
    return played;
}

double max_of(const std::vector<double>& values, int from) {
    return *std::max_element(values.begin() + from, values.end());
}

TEST(JitterBuffer, AfterSilenceOfAnyLengthItIsBackWithinHalfASecond) {
    for (const int silence : {30, 60, 100, 400, 700, 1500, 5000}) {
        for (const bool delivered_late : {false, true}) {
            const int begin = 3000, delay = 50;
            const Played played = play(begin + silence + 2000, [&](int t) {
                const bool silent = t >= begin && t < begin + silence;
                return !silent ? delay : delivered_late ? begin + silence - t + delay : -1;
            });
            const int end = begin + silence + delay;  // the first sample after the silence is here
            EXPECT_EQ(max_of(played.lag, end + 500), delay) << silence << delivered_late;
            EXPECT_LE(max_of(played.step, 0), 1.001 * Buffer::catch_up_speed * 0.001)
                << silence << delivered_late;
        }
    }
}

// As late as the network needs, and no sample is left out once that is known.
TEST(JitterBuffer, JitterIsWaitedForAndForgotten) {
    shared::RandomValues random(7);
    const auto jittery = [&](int t) { return t < 10'000 ? 20 + static_cast<int>(random.below(10)) : 20; };
    const Played played = play(16'000, jittery);
    EXPECT_GE(played.lag[9999], 27);
    EXPECT_LE(played.lag[9999], 30);
    EXPECT_EQ(max_of(played.lag, 13'500), 20);
    EXPECT_LT(played.counts.held, 60u);
    EXPECT_LT(max_of(played.step, 0), 2.0 * hand_speed * 0.001);
}

TEST(JitterBuffer, LossIsWaitedForByAsMuchAsItNeeds) {
    shared::RandomValues random(8);
    const Played played = play(20'000, [&](int) { return random.below(100) < 20 ? -1 : 30; });
    EXPECT_LE(max_of(played.lag, 2000), 30 + 9);
    EXPECT_GT(played.counts.exact, 18'500u);
}

// Between two samples the far hand is where the operator's has not been in any tick.
TEST(JitterBuffer, AfterAWaitItPlaysWholeSamplesAgain) {
    shared::RandomValues random(9);
    const Played played = play(20'000, [&](int) { return random.below(2) == 0 ? -1 : 30; }, {}, 9);
    EXPECT_GT(played.counts.exact, 18'500u);
}

TEST(JitterBuffer, ALongerRouteIsFollowedAndAShorterOneToo) {
    const Played played = play(9000, [](int t) { return t < 3000 ? 20 : t < 6000 ? 60 : 30; });
    EXPECT_EQ(played.lag[5999], 60);
    EXPECT_EQ(max_of(played.lag, 8999), 30);
    EXPECT_LT(max_of(played.step, 0), 2.0 * hand_speed * 0.001);
}

// --- clocks and periods

// Plays with ticks of `seconds` here what is sampled every `sample_seconds` there; the greatest error of the
// hand's place against where it was one delay before.
double worst_error(double seconds, double sample_seconds, double told_sample_seconds) {
    JitterBufferSettings settings;
    settings.seconds = seconds;
    settings.sample_seconds = told_sample_seconds;
    Buffer buffer(settings);
    Sample out;
    double worst = 0.0;
    int sequence = 0;
    const int ticks = static_cast<int>(8.0 / seconds);
    for (int t = 0; t < ticks; ++t) {
        while ((sequence + 1) * sample_seconds <= t * seconds) {
            buffer.insert(sample(++sequence, sample_seconds));
        }
        if (buffer.play(out) == Playing::waiting || t * seconds < 2.0) {
            continue;
        }
        // Anywhere within the lag that there may be: two samples and two ticks.
        double error = 1.0;
        for (double late = 0.0; late <= 2.0 * (sample_seconds + seconds); late += 0.02 * seconds) {
            const double then = (t * seconds - late) / sample_seconds;
            error = std::min(error, std::abs(sample(then, sample_seconds).position.x - out.position.x));
        }
        worst = std::max(worst, error);
    }
    return worst;
}

TEST(JitterBuffer, TheTwoSidesMayTickDifferently) {
    EXPECT_LT(worst_error(0.001, 0.002, 0.002), 5e-6);
    EXPECT_LT(worst_error(0.001, 0.0005, 0.0005), 5e-6);
    EXPECT_LT(worst_error(0.001, 0.0017, 0.0017), 5e-6);
    EXPECT_LT(worst_error(0.002, 0.0003, 0.0003), 5e-6);
}

TEST(JitterBuffer, AClockThatRunsFastIsFollowed) {
    EXPECT_LT(worst_error(0.001, 0.001 * (1.0 - 1e-4), 0.001), 5e-6);
    EXPECT_LT(worst_error(0.001, 0.001 * (1.0 + 1e-4), 0.001), 5e-6);
}

TEST(JitterBuffer, APeriodThatChangesWhileItPlaysMakesNoJump) {
    Buffer buffer;
    Sample out;
    double largest = 0.0, at = 0.0;
    std::uint64_t sequence = 0;
    for (int t = 0; t < 6000; ++t) {
        const double sample_seconds = t < 2000 ? 0.001 : t < 4000 ? 0.0005 : 0.002;
        JitterBufferSettings settings;
        settings.sample_seconds = sample_seconds;
        buffer.set_settings(settings);
        for (at += 0.001; at >= sample_seconds - 1e-9; at -= sample_seconds) {
            Sample next = sample(t);
            next.sequence = ++sequence;
            buffer.insert(next);
        }
        const Vec3 before = out.position;
        buffer.play(out);
        largest = t == 0 ? 0.0 : std::max(largest, glm::distance(before, out.position));
    }
    EXPECT_LT(largest, 0.001 * Buffer::catch_up_speed);
    EXPECT_LE(sequence - out.sequence, 3u);
}

// --- sparse

TEST(JitterBuffer, SparseGoesOnWithTheLastVelocity) {
    Buffer buffer(sparse());
    Sample out;
    buffer.insert({1, Vec3(0.001, 0.0, 0.0), Vec3(1.0, 0.0, 0.0)});
    buffer.play(out);
    for (std::uint64_t sequence = 2; sequence <= 20; ++sequence) {
        ASSERT_EQ(buffer.play(out), Playing::guessed);
        EXPECT_EQ(out.sequence, sequence);
        EXPECT_NEAR(out.position.x, 0.001 * static_cast<double>(sequence), 1e-12);
    }
}

TEST(JitterBuffer, SparseDoesNotGuessForEver) {
    Buffer buffer(sparse());
    Sample out;
    buffer.insert({1, Vec3(0.0), Vec3(1.0, 0.0, 0.0)});
    for (int i = 0; i < 2000; ++i) {
        buffer.play(out);
    }
    EXPECT_NEAR(out.position.x, longest_hand_guess + slow_down_time, 1e-9);
    EXPECT_EQ(out.velocity, Vec3(0.0));
}

// What has not come after so long is lost: the guess slows down at once.
TEST(JitterBuffer, SparseSlowsDownAsSoonAsASampleIsMissing) {
    Buffer buffer(sparse());
    Sample out;
    buffer.insert({1, Vec3(0.0), Vec3(0.7, 0.0, 0.0)});
    double before = 0.0;
    for (int i = 0; i < 40; ++i) {
        buffer.play(out);
        const double step = out.position.x - std::exchange(before, out.position.x);
        EXPECT_LE(step, 0.0007 + 1e-12);
        EXPECT_TRUE(i <= 21 || step < 0.0007 * std::exp(-(i - 22) / 5.0)) << i;
        EXPECT_EQ(buffer.leads(), i >= 2) << i;
    }
    EXPECT_LT(out.position.x, 0.7 * 0.025);
}

TEST(JitterBuffer, SparseGuessesFromWhatComesTooLate) {
    Buffer buffer(sparse());
    Sample out;
    buffer.insert({1, Vec3(0.001, 0.0, 0.0), Vec3(1.0, 0.0, 0.0)});
    for (int i = 0; i < 4; ++i) {
        buffer.play(out);
    }
    buffer.insert({3, Vec3(0.003, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)});
    ASSERT_EQ(buffer.play(out), Playing::guessed);
    EXPECT_NEAR(out.position.x, 0.003, 1e-12);
    EXPECT_NEAR(out.position.y, 0.002, 1e-12);
}

// The first packet may have been the slowest one, or hold samples of long ago.
TEST(JitterBuffer, SparseFollowsTheFastestPacket) {
    Buffer buffer(sparse());
    Sample out;
    for (const std::uint64_t sequence : {1u, 20u, 50u}) {
        buffer.insert({sequence, Vec3(0.001 * sequence, 0.0, 0.0), Vec3(1.0, 0.0, 0.0)});
    }
    ASSERT_EQ(buffer.play(out), Playing::exact);
    EXPECT_EQ(out.sequence, 50u);
    ASSERT_EQ(buffer.play(out), Playing::guessed);
    EXPECT_NEAR(out.position.x, 0.051, 1e-12);
    for (std::uint64_t t = 52; t < 2000; t += 10) {
        buffer.insert({t + 20, Vec3(0.001 * static_cast<double>(t + 20), 0.0, 0.0), Vec3(1.0, 0.0, 0.0)});
        for (int i = 0; i < 10; ++i) {
            buffer.play(out);
        }
    }
    EXPECT_GE(out.sequence, 2010u);
}

// --- a hand that is turned as well

struct TurnedSample : Sample {
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    Vec3 spin{0.0};
};

// Turns about y, so many radians a second.
TurnedSample turned(std::uint64_t sequence, double spin) {
    TurnedSample made;
    made.sequence = sequence;
    made.rotation = turn_by({0.0, spin, 0.0}, 1e-3 * static_cast<double>(sequence));
    made.spin = {0.0, spin, 0.0};
    return made;
}

TEST(JitterBuffer, TurnsAreFilledInBetweenTwoSamples) {
    JitterBufferSettings settings;
    settings.depth = 4;
    JitterBuffer<TurnedSample> buffer(settings);
    TurnedSample out;
    for (std::uint64_t sequence = 1; sequence <= 200; ++sequence) {
        if (sequence % 3 != 0) {
            buffer.insert(turned(sequence, 5.0));
        }
        if (buffer.play(out) != Playing::waiting) {
            const Quat expected = turned(out.sequence, 5.0).rotation;
            EXPECT_LT(angle_between(out.rotation, expected), 1e-9) << sequence;
        }
    }
    EXPECT_GT(buffer.counts().filled, 50u);
}

TEST(JitterBuffer, ATurnIsCarriedOnWithItsSpinUntilItIsTooOld) {
    JitterBufferSettings settings = sparse();
    settings.guess_seconds = 0.1;
    JitterBuffer<TurnedSample> buffer(settings);
    TurnedSample out;
    buffer.insert(turned(1, 2.0));
    for (int i = 0; i < 300; ++i) {
        buffer.play(out);
        const double carried = guessed_time(1e-3 * i);
        EXPECT_NEAR(angle_between(turned(1, 2.0).rotation, out.rotation), 2.0 * carried, 3e-3) << i;
    }
    EXPECT_EQ(out.spin, Vec3(0.0));
}

// Nobody turns a hand by half a turn in a tick, whatever is said.
struct Present : Sample {
    bool connected = true;
};

// A hand that is not there is nowhere: it begins anew where it is when it comes, however it was lost.
TEST(JitterBuffer, AHandThatComesIsNotLedFromWhereItLeft) {
    for (const bool is_sparse : {false, true}) {
        for (const std::uint64_t lost : {0u, 5u, 100u}) {
            JitterBuffer<Present> buffer(is_sparse ? sparse() : JitterBufferSettings{});
            const Vec3 left(0.0, 0.1, 0.0), comes(0.0, -0.1, 0.0);
            Present out;
            int there = 0;
            for (std::uint64_t sequence = 1; sequence <= 1000; ++sequence) {
                const bool is_here = sequence >= 500;
                if (sequence < 500 || sequence >= 500 + lost) {
                    Present sample;
                    sample.sequence = sequence;
                    sample.position = is_here ? comes : left;
                    sample.connected = is_here;
                    buffer.insert(sample);
                }
                if (buffer.play(out) != Playing::waiting && out.connected) {
                    ++there;
                    ASSERT_EQ(out.position.y, comes.y) << is_sparse << ", " << lost << ", " << sequence;
                }
            }
            EXPECT_GT(there, 300);
        }
    }
}

TEST(JitterBuffer, AHandThatFlipsIsTurnedNoFasterThanAHand) {
    using Turned = JitterBuffer<TurnedSample>;
    Turned buffer;
    TurnedSample out;
    Quat before(1.0, 0.0, 0.0, 0.0);
    for (std::uint64_t sequence = 1; sequence <= 300; ++sequence) {
        TurnedSample flipped = turned(sequence, 0.0);
        flipped.rotation = sequence % 40 < 20 ? Quat(1.0, 0.0, 0.0, 0.0) : Quat(0.0, 0.0, 1.0, 0.0);
        flipped.spin = {0.0, 1e4, 0.0};
        buffer.insert(flipped);
        buffer.play(out);
        EXPECT_LE(angle_between(before, out.rotation), Turned::max_spin * 1e-3 + 1e-9) << sequence;
        before = out.rotation;
    }
}

}  // namespace
}  // namespace tactus::jitter_buffer_test
