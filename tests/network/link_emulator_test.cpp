// The network that is not there does what its conditions say, in the same way every time.
#include "network/link_emulator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "support/realtime_audit.hpp"

namespace tactus::link_emulator_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;

struct Arrival {
    std::uint32_t number;
    Nanoseconds sent, arrived, taken;
};

// Sends `count` datagrams of `bytes` bytes, one every `period`, and receives every millisecond until all that
// will ever come has come.
std::vector<Arrival> run(const LinkConditions& conditions, std::uint32_t count, std::uint64_t seed = 7,
                         Nanoseconds period = ms, std::size_t bytes = 100, EmulatorCounts* counts = nullptr) {
    MemoryLinkPair pair(1 << 14);
    LinkEmulator emulator(pair.second(), conditions, seed, 1 << 14);
    std::vector<Arrival> arrivals;
    std::vector<std::byte> datagram(bytes);
    std::array<std::byte, max_datagram_bytes> buffer;
    std::uint32_t sent = 0;
    const Nanoseconds end = count * period + 20'000 * ms;
    for (Nanoseconds now = 0; now < end; now += ms) {
        for (; sent < count && sent * period <= now; ++sent) {
            std::memcpy(datagram.data(), &sent, sizeof sent);
            pair.first().send(datagram, sent * period);
        }
        while (const ReceivedDatagram received = emulator.receive(buffer, now)) {
            EXPECT_EQ(received.bytes, bytes);
            Arrival arrival{};
            std::memcpy(&arrival.number, buffer.data(), sizeof arrival.number);
            arrival.sent = arrival.number * period;
            arrival.arrived = received.arrived;
            arrival.taken = now;
            arrivals.push_back(arrival);
        }
    }
    if (counts != nullptr) {
        *counts = emulator.counts();
    }
    return arrivals;
}

std::vector<double> delays_ms(const std::vector<Arrival>& arrivals) {
    std::vector<double> delays;
    for (const Arrival& arrival : arrivals) {
        delays.push_back(static_cast<double>(arrival.arrived - arrival.sent) / ms);
    }
    return delays;
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) {
        sum += (value - mean(values)) * (value - mean(values));
    }
    return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(LinkEmulator, WithoutConditionsEverythingPassesAtOnceAndInOrder) {
    const std::vector<Arrival> arrivals = run({}, 1000);
    ASSERT_EQ(arrivals.size(), 1000u);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        EXPECT_EQ(arrivals[i].number, i);
        EXPECT_EQ(arrivals[i].arrived, arrivals[i].sent);
        EXPECT_EQ(arrivals[i].taken, arrivals[i].sent);
    }
}

TEST(LinkEmulator, ADelayIsExactAndTheTickAfterItTakes) {
    LinkConditions conditions;
    conditions.delay = 100 * ms + 300'000;
    for (const Arrival& arrival : run(conditions, 500)) {
        EXPECT_EQ(arrival.arrived - arrival.sent, 100 * ms + 300'000);
        EXPECT_EQ(arrival.taken - arrival.sent, 101 * ms);
    }
}

TEST(LinkEmulator, TheSameSeedIsTheSameNetwork) {
    LinkConditions conditions;
    conditions.delay = 20 * ms;
    conditions.jitter = 5 * ms;
    conditions.shape = JitterShape::normal;
    conditions.loss = 0.2;
    conditions.duplication = 0.1;
    conditions.reordering = 0.1;
    const auto same = [](const std::vector<Arrival>& a, const std::vector<Arrival>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Arrival& x, const Arrival& y) {
            return x.number == y.number && x.arrived == y.arrived;
        });
    };
    EXPECT_TRUE(same(run(conditions, 2000, 3), run(conditions, 2000, 3)));
    EXPECT_FALSE(same(run(conditions, 2000, 3), run(conditions, 2000, 4)));
}

TEST(LinkEmulator, ChangingOneConditionLeavesTheLuckOfTheOthers) {
    LinkConditions conditions;
    conditions.loss = 0.3;
    const auto numbers = [](const std::vector<Arrival>& arrivals) {
        std::vector<std::uint32_t> found;
        for (const Arrival& arrival : arrivals) {
            found.push_back(arrival.number);
        }
        std::sort(found.begin(), found.end());
        return found;
    };
    const std::vector<std::uint32_t> without = numbers(run(conditions, 1000));
    conditions.jitter = 30 * ms;
    conditions.delay = 50 * ms;
    EXPECT_EQ(numbers(run(conditions, 1000)), without);
}

TEST(LinkEmulator, UniformJitterFillsItsRangeEvenly) {
    LinkConditions conditions;
    conditions.delay = 50 * ms;
    conditions.jitter = 10 * ms;
    const std::vector<double> delays = delays_ms(run(conditions, 10'000));
    EXPECT_NEAR(mean(delays), 50.0, 0.2);
    EXPECT_NEAR(deviation(delays), 10.0 / std::sqrt(3.0), 0.1);
    EXPECT_GE(*std::min_element(delays.begin(), delays.end()), 40.0);
    EXPECT_LE(*std::max_element(delays.begin(), delays.end()), 60.0);
}

TEST(LinkEmulator, NormalJitterHasItsDeviation) {
    LinkConditions conditions;
    conditions.delay = 50 * ms;
    conditions.jitter = 5 * ms;
    conditions.shape = JitterShape::normal;
    const std::vector<double> delays = delays_ms(run(conditions, 10'000));
    EXPECT_NEAR(mean(delays), 50.0, 0.2);
    EXPECT_NEAR(deviation(delays), 5.0, 0.1);
}

TEST(LinkEmulator, HeavyTailIsNeverEarlyAndSeldomVeryLate) {
    LinkConditions conditions;
    conditions.delay = 50 * ms;
    conditions.jitter = 5 * ms;
    conditions.shape = JitterShape::heavy_tail;
    std::vector<double> delays = delays_ms(run(conditions, 10'000));
    std::sort(delays.begin(), delays.end());
    EXPECT_GE(delays.front(), 50.0);
    EXPECT_NEAR(mean(delays), 55.0, 0.3);
    EXPECT_LT(delays[delays.size() / 2], 54.0);
    EXPECT_GT(delays.back(), 90.0);
}

TEST(LinkEmulator, NoDelayIsNegative) {
    LinkConditions conditions;
    conditions.delay = ms;
    conditions.jitter = 10 * ms;
    for (const double delay : delays_ms(run(conditions, 1000))) {
        EXPECT_GE(delay, 0.0);
    }
}

TEST(LinkEmulator, ATraceIsPlayedOverAndOver) {
    const DelayTrace trace{{10 * ms, DelayTrace::lost, 30 * ms}};
    LinkConditions conditions;
    conditions.delay = ms;
    conditions.shape = JitterShape::trace;
    conditions.trace = &trace;
    for (const Arrival& arrival : run(conditions, 300)) {
        EXPECT_NE(arrival.number % 3, 1u);
        EXPECT_EQ(arrival.arrived - arrival.sent, arrival.number % 3 == 0 ? 11 * ms : 31 * ms);
    }
}

TEST(LinkEmulator, ACopyTakesAsLongAsTheTraceSays) {
    const DelayTrace trace{{50 * ms, 60 * ms}};
    LinkConditions conditions;
    conditions.shape = JitterShape::trace;
    conditions.trace = &trace;
    conditions.duplication = 1.0;
    const std::vector<Arrival> arrivals = run(conditions, 100);
    EXPECT_EQ(arrivals.size(), 200u);
    for (const Arrival& arrival : arrivals) {
        EXPECT_EQ(arrival.arrived - arrival.sent, arrival.number % 2 == 0 ? 50 * ms : 60 * ms);
    }
}

TEST(LinkEmulator, TheTraceGoesOnWithWhatIsLost) {
    const DelayTrace trace{{10 * ms, 20 * ms, 30 * ms}};
    LinkConditions conditions;
    conditions.shape = JitterShape::trace;
    conditions.trace = &trace;
    conditions.loss = 0.5;
    for (const Arrival& arrival : run(conditions, 300)) {
        EXPECT_EQ(arrival.arrived - arrival.sent, (1 + arrival.number % 3) * 10 * ms);
    }
}

TEST(LinkEmulator, TheLongestDelayLosesNothing) {
    MemoryLinkPair pair(1 << 10);
    LinkConditions conditions;
    conditions.delay = 10'000 * ms;
    LinkEmulator emulator(pair.second(), conditions, 1);
    std::array<std::byte, max_datagram_bytes> buffer{};
    std::uint64_t arrived = 0;
    for (int tick = 0; tick < 22'000; ++tick) {
        if (tick < 11'000) {
            pair.first().send(std::span(buffer).first(200), tick * ms);
            pair.first().send(std::span(buffer).first(200), tick * ms);
        }
        while (emulator.receive(buffer, tick * ms)) {
            ++arrived;
        }
    }
    EXPECT_EQ(arrived, 22'000u);
    EXPECT_EQ(emulator.counts().no_room, 0u);
}

TEST(LinkEmulator, BothWaysOfASeedAndTheNextSeedHaveLuckOfTheirOwn) {
    LinkConditions conditions;
    conditions.loss = 0.5;
    const auto came = [&](std::uint64_t seed) {
        std::vector<double> found(10'000, 0.0);
        for (const Arrival& arrival : run(conditions, 10'000, seed)) {
            found[arrival.number] = 1.0;
        }
        return found;
    };
    const std::vector<std::uint64_t> seeds{luck_of(1, Way::to_teleoperator), luck_of(1, Way::to_operator),
                                           luck_of(2, Way::to_teleoperator), luck_of(2, Way::to_operator)};
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const std::vector<double> one = came(seeds[i]), other = came(seeds[j]);
            double sum = 0.0;
            for (std::size_t k = 0; k < one.size(); ++k) {
                sum += (one[k] - 0.5) * (other[k] - 0.5);
            }
            // Four standard deviations of no correlation.
            EXPECT_NEAR(sum / 10'000.0 / 0.25, 0.0, 0.04) << i << " and " << j;
        }
    }
}

TEST(LinkEmulator, JitterDisordersUnlessToldToKeepOrder) {
    const auto is_ordered = [](const std::vector<Arrival>& arrivals) {
        return std::is_sorted(arrivals.begin(), arrivals.end(),
                              [](const Arrival& a, const Arrival& b) { return a.number < b.number; });
    };
    LinkConditions conditions;
    conditions.delay = 50 * ms;
    conditions.jitter = 20 * ms;
    EXPECT_FALSE(is_ordered(run(conditions, 1000)));
    conditions.keep_order = true;
    EXPECT_TRUE(is_ordered(run(conditions, 1000)));
}

TEST(LinkEmulator, HeldBackDatagramsAreOvertaken) {
    LinkConditions conditions;
    conditions.delay = 20 * ms;
    conditions.keep_order = true;
    conditions.reordering = 0.1;
    conditions.reorder_by = 5 * ms;
    EmulatorCounts counts;
    const std::vector<Arrival> arrivals = run(conditions, 5000, 1, ms, 100, &counts);
    ASSERT_EQ(arrivals.size(), 5000u);
    EXPECT_NEAR(static_cast<double>(counts.held_back), 500.0, 80.0);
    std::uint64_t late = 0;
    for (const Arrival& arrival : arrivals) {
        late += arrival.arrived - arrival.sent == 25 * ms ? 1 : 0;
    }
    EXPECT_EQ(late, counts.held_back);
}

TEST(LinkEmulator, LosesItsShare) {
    LinkConditions conditions;
    conditions.loss = 0.5;
    EmulatorCounts counts;
    const auto arrivals = run(conditions, 10'000, 2, ms, 100, &counts);
    EXPECT_NEAR(static_cast<double>(arrivals.size()), 5000.0, 200.0);
    EXPECT_EQ(counts.lost + counts.delivered, counts.arrived);
}

TEST(LinkEmulator, BurstsLoseTheirShareInRuns) {
    LinkConditions conditions;
    conditions.burst = bursts(0.1, 20.0);
    const std::vector<Arrival> arrivals = run(conditions, 16'000);
    EXPECT_NEAR(static_cast<double>(arrivals.size()), 14'400.0, 700.0);
    std::uint32_t gaps = 0;
    for (std::size_t i = 1; i < arrivals.size(); ++i) {
        gaps += arrivals[i].number != arrivals[i - 1].number + 1 ? 1 : 0;
    }
    const double mean_gap = (16'000.0 - static_cast<double>(arrivals.size())) / gaps;
    EXPECT_NEAR(mean_gap, 20.0, 5.0);
}

TEST(LinkEmulator, BurstModelsOfTheLimits) {
    EXPECT_EQ(bursts(0.0, 5.0).enter, 0.0);
    LinkConditions conditions;
    conditions.burst = bursts(1.0, 5.0);
    EXPECT_TRUE(run(conditions, 100).empty());
    const BurstLoss impossible = bursts(0.9, 1.0);  // nine of ten lost, yet never two in a row
    EXPECT_NEAR(impossible.enter / (impossible.enter + impossible.leave), 0.9, 1e-12);
}

TEST(LinkEmulator, DoublesItsShare) {
    LinkConditions conditions;
    conditions.delay = 10 * ms;
    conditions.jitter = 3 * ms;
    conditions.duplication = 0.25;
    EmulatorCounts counts;
    const auto arrivals = run(conditions, 4000, 3, ms, 100, &counts);
    EXPECT_EQ(arrivals.size(), 4000u + counts.duplicated);
    EXPECT_NEAR(static_cast<double>(counts.duplicated), 1000.0, 120.0);
}

// With the headers of UDP and IPv4 a datagram of 100 bytes has 128.
TEST(LinkEmulator, TheNarrowPlaceLetsItsRatePassAndDropsTheRest) {
    LinkConditions conditions;
    conditions.rate = 512'000.0;  // half of the 1024 kbit/s that are sent
    conditions.max_waiting = 50 * ms;
    EmulatorCounts counts;
    const auto arrivals = run(conditions, 4000, 1, ms, 100, &counts);
    EXPECT_NEAR(static_cast<double>(arrivals.size()), 2000.0, 30.0);
    EXPECT_EQ(counts.squeezed + arrivals.size(), 4000u);
    for (const double delay : delays_ms(arrivals)) {
        EXPECT_LE(delay, 52.0);
    }
}

TEST(LinkEmulator, ALoneDatagramTakesTheTimeOfItsBits) {
    LinkConditions conditions;
    conditions.rate = 1e6;
    const auto arrivals = run(conditions, 10, 1, 100 * ms, 1000);
    for (const Arrival& arrival : arrivals) {
        EXPECT_EQ(arrival.arrived - arrival.sent, 8'224'000);
    }
}

TEST(LinkEmulator, WhatIsUnderWayIsBounded) {
    MemoryLinkPair pair(1024);
    LinkConditions conditions;
    conditions.delay = 1000 * ms;
    LinkEmulator emulator(pair.second(), conditions, 1, 16);
    std::array<std::byte, max_datagram_bytes> buffer{};
    for (int i = 0; i < 100; ++i) {
        pair.first().send(std::span(buffer).first(10), 0);
    }
    EXPECT_FALSE(emulator.receive(buffer, 0));
    EXPECT_EQ(emulator.counts().no_room, 84u);
    int arrived = 0;
    while (emulator.receive(buffer, 1000 * ms)) {
        ++arrived;
    }
    EXPECT_EQ(arrived, 16);
}

TEST(LinkEmulator, ConditionsMayChangeWhileDatagramsAreUnderWay) {
    MemoryLinkPair pair;
    LinkConditions conditions;
    conditions.delay = 100 * ms;
    LinkEmulator emulator(pair.second(), conditions, 1);
    std::array<std::byte, max_datagram_bytes> buffer{};
    pair.first().send(std::span(buffer).first(1), 0);
    EXPECT_FALSE(emulator.receive(buffer, 0));
    conditions.delay = 10 * ms;
    emulator.change(conditions);
    pair.first().send(std::span(buffer).first(2), ms);
    EXPECT_EQ(emulator.receive(buffer, 11 * ms).bytes, 2u);
    EXPECT_EQ(emulator.receive(buffer, 100 * ms).bytes, 1u);
}

TEST(LinkEmulator, ATickAllocatesLocksAndAsksForNothing) {
    MemoryLinkPair pair;
    LinkConditions conditions;
    conditions.delay = 5 * ms;
    conditions.jitter = 3 * ms;
    conditions.shape = JitterShape::heavy_tail;
    conditions.duplication = 0.2;
    conditions.loss = 0.2;
    conditions.burst = bursts(0.1, 3.0);
    conditions.rate = 1e7;
    LinkEmulator emulator(pair.second(), conditions, 1);
    std::array<std::byte, max_datagram_bytes> buffer{};
    testing::AuditScope audit;
    for (Nanoseconds now = 0; now < 2000 * ms; now += ms) {
        pair.first().send(std::span(buffer).first(200), now);
        while (emulator.receive(buffer, now)) {
        }
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees() + audit.locks() + audit.waits() + audit.system_calls(), 0u)
        << audit.describe();
    EXPECT_GT(emulator.counts().delivered, 1000u);
}

TEST(LinkConditions, WhatIsNotAsItReadsIsSaid) {
    LinkConditions conditions;
    conditions.delay = 10 * ms;
    conditions.jitter = 10 * ms;
    EXPECT_TRUE(notes_on(conditions, 0.5, 1.0).empty());
    EXPECT_EQ(notes_on(conditions, 0.9, 1.0).size(), 1u);
    conditions.jitter = 30 * ms;
    conditions.keep_order = true;
    const std::vector<std::string> notes = notes_on(conditions, 0.0, 5.0);
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_NE(notes[0].find("the mean is 13.3 ms"), std::string::npos) << notes[0];
    conditions.keep_order = false;
    conditions.delay = 50 * ms;
    conditions.jitter = 20 * ms;
    conditions.shape = JitterShape::normal;
    const std::vector<std::string> normal = notes_on(conditions, 0.0, 5.0);
    ASSERT_EQ(normal.size(), 1u);
    const double told = std::stod(normal[0].substr(normal[0].find("mean is ") + 8));
    EXPECT_NEAR(told, mean(delays_ms(run(conditions, 20'000))), 0.4);
}

TEST(DelayTrace, ReadsMillisecondsLossesAndComments) {
    const DelayTraceResult result = parse_delay_trace("# a recorded way\n12.5\r\n\n  lost # tunnel\n0");
    EXPECT_EQ(result.error, "");
    EXPECT_EQ(result.trace.delays, (std::vector<Nanoseconds>{12'500'000, DelayTrace::lost, 0}));
}

TEST(DelayTrace, SaysWhichLineIsWrong) {
    for (const char* text : {"1\n2\nabc\n", "1\n2\n-3\n", "1\n2\n3 4\n", "1\n2\nnan\n", "1\n2\n1e99\n"}) {
        EXPECT_EQ(parse_delay_trace(text).error.find("line 3: "), 0u) << text;
    }
    EXPECT_NE(parse_delay_trace("# nothing\n").error, "");
    EXPECT_NE(parse_delay_trace("").error, "");
}

TEST(ClockSkew, RunsAheadAndFaster) {
    const ClockSkew skew{1000 * ms, 7, 1e-3};
    EXPECT_EQ(skew.shown_at(1000 * ms), 1000 * ms + 7);
    EXPECT_EQ(skew.shown_at(2000 * ms), 2001 * ms + 7);
    EXPECT_EQ(ClockSkew{}.shown_at(123), 123);
}

TEST(MemoryLink, RefusesTheEmptyTheTooLongAndTheFull) {
    MemoryLinkPair pair(2);
    std::array<std::byte, max_datagram_bytes + 1> bytes{};
    EXPECT_FALSE(pair.first().send({}, 0));
    EXPECT_FALSE(pair.first().send(bytes, 0));
    EXPECT_TRUE(pair.first().send(std::span(bytes).first(max_datagram_bytes), 0));
    EXPECT_TRUE(pair.first().send(std::span(bytes).first(1), 5));
    EXPECT_FALSE(pair.first().send(std::span(bytes).first(1), 0));
    EXPECT_EQ(pair.first_refused(), 3u);

    const ReceivedDatagram second = pair.second().receive(std::span(bytes).first(10), 9);
    EXPECT_EQ(second.bytes, 1u) << "the one that does not fit is dropped";
    EXPECT_EQ(second.arrived, 5);
    EXPECT_EQ(pair.second_refused(), 1u);
    EXPECT_FALSE(pair.first().receive(bytes, 9));
}

}  // namespace
}  // namespace tactus::link_emulator_test
