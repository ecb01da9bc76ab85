// What an operator sends of its hands: all of it, in few packets, and fewer when the network cannot take
// more.
#include "network/sample_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>

#include "endpoint_rig.hpp"
#include "shared/random_values.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::sample_stream_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;

struct StreamRig {
    explicit StreamRig(const LinkConditions& conditions = {}) : rig(conditions) {
        rig.on_far([this](const Message& message) {
            const auto& samples = std::get<OperatorSamples>(message);
            ++packets;
            for (std::size_t i = 0; i < samples.count; ++i) {
                heard[samples.samples[i].pointer].insert(samples.samples[i].sequence);
            }
        });
    }
    void run(Nanoseconds span, int pointers = 1) {
        rig.run(span, [&] {
            ++sequence;
            for (int pointer = 0; pointer < pointers; ++pointer) {
                OperatorSample sample;
                sample.sequence = sequence;
                sample.time = rig.now();
                sample.pointer = static_cast<std::uint16_t>(pointer);
                sample.connected = true;
                const double t = 1e-3 * static_cast<double>(sequence);
                sample.position = {0.1 * std::sin(5.0 * t), 0.2 * std::cos(4.0 * t), 0.1 * pointer};
                sample.velocity = {0.5 * std::cos(5.0 * t), -0.8 * std::sin(4.0 * t), 0.0};
                sample.force = {0.0, 5.0 * std::sin(3.0 * t), 0.0};
                if (trembles) {
                    sample.position += random.in_ball(6e-5);
                    sample.velocity += random.in_ball(0.02);
                    sample.force += random.in_ball(0.1);
                }
                stream.add(sample);
            }
            stream.end_tick(rig.near(), rig.now());
        });
    }

    EndpointRig rig;
    SampleStream stream{{15, 16, ms}};
    bool trembles = false;  // as a hand does that is told by encoders
    shared::RandomValues random{5};
    std::uint64_t sequence = 0;
    std::uint64_t packets = 0;
    std::map<std::uint16_t, std::set<std::uint64_t>> heard;
};

LinkConditions lossy(double loss) {
    LinkConditions conditions;
    conditions.delay = 20 * ms;
    conditions.loss = loss;
    return conditions;
}

TEST(SampleStream, EverySampleComesWhereNothingIsLost) {
    StreamRig rig;
    rig.run(50 * ms);
    const std::uint64_t from = rig.sequence;
    rig.run(2000 * ms);
    rig.rig.run(5 * ms);
    for (std::uint64_t sequence = from; sequence <= rig.sequence; ++sequence) {
        ASSERT_TRUE(rig.heard[0].contains(sequence)) << sequence;
    }
    EXPECT_EQ(rig.stream.repeats(), 2u);
    EXPECT_EQ(rig.stream.ticks_a_packet(), 1u);
}

// One hand, every tick, with all that IP and UDP add.
TEST(SampleStream, AHandTakesAtMostOneAndAHalfMegabits) {
    for (const bool trembles : {false, true}) {
        for (const double loss : {0.0, 0.02, 0.09, 0.3, 0.5}) {
            StreamRig rig(lossy(loss));
            rig.trembles = trembles;
            rig.run(5000 * ms);
            for (int second = 0; second < 3; ++second) {
                rig.run(1000 * ms);
                const LinkStatistics& link = rig.rig.near().statistics();
                EXPECT_LT(link.sent_rate.bits_per_s, 1.5e6) << loss;
                EXPECT_GT(link.sent_rate.bits_per_s, 0.1e6) << loss;
            }
        }
    }
}

TEST(SampleStream, WhatIsLostIsRepeatedByNeed) {
    StreamRig rig(lossy(0.09));
    rig.run(4000 * ms);
    const std::uint64_t from = rig.sequence;
    int seconds_with_more = 0;
    for (int second = 0; second < 20; ++second) {
        rig.run(1000 * ms);
        seconds_with_more += rig.stream.repeats() > 2 ? 1 : 0;
    }
    rig.rig.run(100 * ms);
    std::size_t lost = 0;
    for (std::uint64_t sequence = from; sequence <= rig.sequence; ++sequence) {
        lost += rig.heard[0].contains(sequence) ? 0 : 1;
    }
    EXPECT_LE(lost, 40u) << "one in five hundred, of which a tenth is left to the other side's guess";
    EXPECT_GE(seconds_with_more, 15) << "but for two seconds in which less is tried";
}

TEST(SampleStream, ALineThatIsTooNarrowIsNotFilledUp) {
    LinkConditions narrow;
    narrow.delay = 10 * ms;
    narrow.rate = 500'000.0;
    StreamRig rig(narrow);
    rig.run(10'000 * ms);
    EXPECT_GE(rig.stream.ticks_a_packet(), 2u);
    const double delay_when_used = rig.rig.near().statistics().clock.mean_delay;
    rig.run(10'000 * ms);
    EXPECT_LT(rig.rig.near().statistics().clock.mean_delay, std::max(120e6, delay_when_used));
    double longest = 0.0;
    for (int i = 0; i < 10'000; ++i) {
        rig.run(ms);
        longest = std::max(longest, rig.rig.far().statistics().one_way_delay);
    }
    EXPECT_LT(longest, 90e6) << "ns, of which the way takes 10 and a full queue 200";
    rig.rig.near_link().change({});
    rig.rig.far_link().change({});
    rig.run(60'000 * ms);
    EXPECT_EQ(rig.stream.ticks_a_packet(), 1u) << "and all is as before when it is wide again";
}

// What is lost by chance is not made less by sending less: repeats are what helps.
TEST(SampleStream, LossesThatStayAsTheyAreSlowNothingDown) {
    for (const double loss : {0.12, 0.5}) {
        StreamRig rig(lossy(loss));
        rig.run(6000 * ms);
        EXPECT_EQ(rig.stream.ticks_a_packet(), 1u) << loss;
        const std::uint64_t from = rig.sequence;
        rig.run(20'000 * ms);
        EXPECT_EQ(rig.stream.ticks_a_packet(), 1u) << loss;
        rig.rig.run(100 * ms);
        std::size_t lost = 0;
        for (std::uint64_t sequence = from; sequence <= rig.sequence; ++sequence) {
            lost += rig.heard[0].contains(sequence) ? 0 : 1;
        }
        EXPECT_LE(lost, 60u) << loss;
    }
}

// Whether less helps is asked while a hand is at work: it costs few samples.
TEST(SampleStream, AskingWhetherLessHelpsLosesLittle) {
    StreamRig rig(lossy(0.5));
    rig.run(300 * ms);
    const std::uint64_t from = rig.sequence;
    std::uint32_t longest_stride = 0;
    for (int i = 0; i < 4000; ++i) {
        rig.run(1 * ms);
        longest_stride = std::max(longest_stride, rig.stream.ticks_a_packet());
    }
    const std::uint64_t to = rig.sequence;
    rig.rig.run(100 * ms);
    std::size_t lost = 0;
    for (std::uint64_t sequence = from; sequence <= to; ++sequence) {
        lost += rig.heard[0].contains(sequence) ? 0 : 1;
    }
    EXPECT_EQ(longest_stride, 2u);
    EXPECT_LE(lost, 100u);
}

// A way that keeps nothing back and drops what is too much.
TEST(SampleStream, LossesThatSendingLessMakesFewerAreHeeded) {
    LinkConditions narrow;
    narrow.delay = 10 * ms;
    narrow.rate = 640'000.0;
    narrow.max_waiting = 3 * ms;
    StreamRig rig(narrow);
    rig.run(18'000 * ms);
    EXPECT_GE(rig.stream.ticks_a_packet(), 2u);
    EXPECT_LT(rig.rig.near().statistics().lost_there, 0.1);
}

TEST(SampleStream, SeveralPointersShareAPacket) {
    StreamRig rig;
    rig.run(50 * ms);
    rig.packets = 0;
    rig.run(1000 * ms, 3);
    EXPECT_LE(rig.packets, 1001u);
    rig.packets = 0;
    rig.run(1000 * ms, 16);
    EXPECT_LE(rig.packets, 4u * 1001u);
    for (std::uint16_t pointer = 0; pointer < 16; ++pointer) {
        EXPECT_GT(rig.heard[pointer].size(), 990u);
    }
}

// Who knows no tools refuses a packet of theirs, and must hear of the fingertips.
TEST(SampleStream, ToolsGoInPacketsOfTheirOwn) {
    EndpointRig rig{LinkConditions{}};
    SampleStream stream{{15, 20, ms}};
    std::size_t of_tools = 0, of_fingertips = 0, mixed = 0;
    rig.on_far([&](const Message& message) {
        const auto& samples = std::get<OperatorSamples>(message);
        const auto all = std::span(samples.samples).first(samples.count);
        const auto tools = std::ranges::count_if(all, &OperatorSample::has_turn);
        of_tools += tools > 0 ? 1 : 0;
        of_fingertips += tools == 0 ? 1 : 0;
        mixed += tools > 0 && tools < samples.count ? 1 : 0;
    });
    std::uint64_t sequence = 0;
    rig.run(200 * ms, [&] {
        ++sequence;
        for (const std::uint16_t pointer : {0, 1, 16, 17}) {
            OperatorSample sample;
            sample.sequence = sequence;
            sample.time = rig.now();
            sample.pointer = pointer;
            sample.has_turn = pointer >= first_tool;
            stream.add(sample);
        }
        stream.end_tick(rig.near(), rig.now());
    });
    EXPECT_GT(of_tools, 100u);
    EXPECT_GT(of_fingertips, 100u);
    EXPECT_EQ(mixed, 0u);
}

TEST(SampleStream, WhatMayNotBeSentKeepsNobodyElseBack) {
    StreamRig rig;
    rig.run(50 * ms);
    rig.heard.clear();
    rig.rig.run(100 * ms, [&] {
        OperatorSample good, bad;
        good.sequence = bad.sequence = ++rig.sequence;
        good.time = bad.time = rig.rig.now();
        bad.pointer = 1;
        bad.position.y = std::numeric_limits<double>::quiet_NaN();
        rig.stream.add(bad);
        rig.stream.add(good);
        rig.stream.end_tick(rig.rig.near(), rig.rig.now());
    });
    rig.rig.run(2 * ms);
    EXPECT_GE(rig.heard[0].size(), 100u);
    EXPECT_FALSE(rig.heard.contains(1));
}

TEST(SampleStream, ATickAllocatesNothing) {
    StreamRig rig;
    rig.run(50 * ms);
    testing::AuditScope audit;
    for (int i = 0; i < 100; ++i) {
        OperatorSample sample;
        sample.sequence = ++rig.sequence;
        sample.time = rig.rig.now();
        rig.stream.add(sample);
        rig.stream.end_tick(rig.rig.near(), rig.rig.now());
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees() + audit.locks() + audit.system_calls(), 0u)
        << audit.describe();
}

}  // namespace
}  // namespace tactus::sample_stream_test
