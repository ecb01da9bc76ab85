// Two sides meet, lose each other, restart and leave; and what others throw at them.
#include "network/endpoint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "endpoint_rig.hpp"
#include "shared/wire_samples.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::endpoint_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;

LinkConditions delayed(Nanoseconds delay) {
    LinkConditions conditions;
    conditions.delay = delay;
    return conditions;
}

using samples::force;

double newtons_of(const Message& message) {
    return std::get<ForceSamples>(message).samples[0].force.y;
}

TEST(Endpoint, TwoSidesMeetWithinTwoDelays) {
    EndpointRig rig(delayed(50 * ms));
    rig.run(40 * ms);
    EXPECT_EQ(rig.near().statistics().peer, PeerState::silent);
    rig.run(70 * ms);
    EXPECT_EQ(rig.near().statistics().peer, PeerState::connected);
    EXPECT_EQ(rig.far().statistics().peer, PeerState::connected);
    EXPECT_EQ(rig.near().peer_epoch(), 22u);
    EXPECT_EQ(rig.far().peer_epoch(), 11u);
}

TEST(Endpoint, MessagesArriveInOrderWithTheirValues) {
    EndpointRig rig;
    rig.run(10 * ms);
    double newtons = 0.0;
    rig.run(100 * ms, [&] { rig.far().send(force(newtons += 1.0)); });
    rig.run(2 * ms);
    ASSERT_EQ(rig.near_heard().size(), 100u);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_NEAR(newtons_of(rig.near_heard()[i]), static_cast<double>(i + 1), 1e-9);
    }
}

TEST(Endpoint, ALateJoinerIsMetAtOnce) {
    EndpointRig rig(delayed(20 * ms));
    rig.stop_far();
    rig.run(5000 * ms);
    EXPECT_EQ(rig.near().statistics().peer, PeerState::silent);
    rig.start_far(23);
    rig.run(150 * ms);
    EXPECT_TRUE(rig.near().connected());
    EXPECT_TRUE(rig.far().connected());
    EXPECT_EQ(rig.far().statistics().missing, 0u) << "what was sent before it came was not lost";
}

TEST(Endpoint, ARestartIsAnotherEpoch) {
    EndpointRig rig(delayed(20 * ms));
    rig.run(500 * ms);
    rig.start_far(99);
    rig.run(100 * ms);
    EXPECT_EQ(rig.near().peer_epoch(), 99u);
    EXPECT_EQ(rig.near().statistics().peer_restarts, 1u);
    EXPECT_TRUE(rig.near().connected());
    EXPECT_TRUE(rig.far().connected());
    EXPECT_GT(rig.near().statistics().clock.exchanges, 0u);
}

TEST(Endpoint, WhatIsLeftOfAnEarlierEpochIsDropped) {
    EndpointRig rig(delayed(20 * ms));
    rig.run(500 * ms, [&] { rig.far().send(force(1.0)); });
    // Held up for half a second, behind the restart.
    rig.near_link().change(delayed(500 * ms));
    rig.run(5 * ms, [&] { rig.far().send(force(1.0)); });
    rig.near_link().change(delayed(20 * ms));
    rig.start_far(99);
    rig.run(100 * ms);
    rig.near_heard().clear();
    rig.run(1000 * ms);
    EXPECT_EQ(rig.near().peer_epoch(), 99u);
    EXPECT_TRUE(rig.near_heard().empty());
    EXPECT_GE(rig.near().statistics().strange_epoch, 4u);
}

TEST(Endpoint, AnOldHelloDoesNotBringAnEpochBack) {
    EndpointRig rig;
    rig.run(300 * ms);
    std::array<std::byte, max_message_bytes> old;
    const std::size_t size = encode({22, 500, 0}, Hello{Side::teleoperator_side}, old);
    rig.start_far(99);
    rig.run(300 * ms);
    rig.far_wire().send(std::span(old).first(size), rig.now());
    rig.run(10 * ms);
    EXPECT_EQ(rig.near().peer_epoch(), 99u);
    EXPECT_TRUE(rig.near().connected());
}

TEST(Endpoint, APeerThatVanishesIsMissedAndFoundAgain) {
    EndpointRig rig;
    rig.run(500 * ms);
    LinkConditions nothing;
    nothing.loss = 1.0;
    rig.near_link().change(nothing);
    rig.run(900 * ms);
    EXPECT_EQ(rig.near().statistics().peer, PeerState::connected);
    rig.run(200 * ms);
    EXPECT_EQ(rig.near().statistics().peer, PeerState::vanished);
    EXPECT_EQ(rig.near().statistics().vanishings, 1u);
    rig.near_link().change({});
    rig.run(300 * ms);
    EXPECT_TRUE(rig.near().connected());
    EXPECT_TRUE(rig.far().connected());
    EXPECT_EQ(rig.near().statistics().peer_restarts, 0u);
}

TEST(Endpoint, OneWayIsSeenFromBothSides) {
    EndpointRig rig;
    LinkConditions nothing;
    nothing.loss = 1.0;
    rig.near_link().change(nothing);
    rig.run(2000 * ms);
    EXPECT_EQ(rig.near().statistics().peer, PeerState::silent);
    EXPECT_EQ(rig.far().statistics().peer, PeerState::one_way);
}

TEST(Endpoint, AByeIsFinalForItsEpoch) {
    EndpointRig rig(delayed(10 * ms));
    rig.run(300 * ms);
    rig.far().leave();
    rig.stop_far();
    rig.run(2000 * ms);
    EXPECT_EQ(rig.near().statistics().peer, PeerState::left);
    EXPECT_EQ(rig.near().statistics().vanishings, 0u);
    rig.start_far(33);
    rig.run(200 * ms);
    EXPECT_TRUE(rig.near().connected());
}

TEST(Endpoint, TwoOperatorsDoNotTalk) {
    EndpointRig rig;
    rig.start_far(33, Side::operator_side);
    rig.run(300 * ms, [&] { rig.far().send(force(1.0)); });
    EXPECT_EQ(rig.near().statistics().peer, PeerState::wrong_side);
    EXPECT_TRUE(rig.near_heard().empty());
}

TEST(Endpoint, CopiesAreDroppedAndLossesCounted) {
    LinkConditions conditions;
    conditions.delay = 30 * ms;
    conditions.jitter = 10 * ms;
    conditions.loss = 0.1;
    conditions.duplication = 0.2;
    EndpointRig rig(conditions);
    rig.run(1000 * ms);
    double newtons = 0.0;
    rig.run(5000 * ms, [&] { rig.far().send(force(newtons += 0.125)); });
    rig.run(200 * ms);
    std::vector<double> seen;
    for (const Message& message : rig.near_heard()) {
        seen.push_back(newtons_of(message));
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
    EXPECT_NEAR(static_cast<double>(seen.size()), 4500.0, 100.0);
    const LinkStatistics& statistics = rig.near().statistics();
    EXPECT_NEAR(static_cast<double>(statistics.missing), 500.0, 120.0);
    EXPECT_GT(statistics.copies, 700u);
    EXPECT_GT(statistics.late, 1000u);
    EXPECT_TRUE(rig.near().connected()) << "however much is overtaken";
}

TEST(Endpoint, KnowsTheFarClockAndTheWayItTakes) {
    EndpointRig rig(delayed(40 * ms));
    rig.far().set_skew({0, 3'600'000 * ms, 100e-6});
    rig.run(30'000 * ms);
    const Nanoseconds now = rig.now();
    EXPECT_NEAR(static_cast<double>(rig.near().clock().far_time(now) - rig.far().local_time(now)), 0.0, 20e3);
    EXPECT_NEAR(rig.near().clock().figures().drift, 100e-6, 5e-6);
    EXPECT_NEAR(rig.near().statistics().one_way_delay, 40e6, 20e3);
    EXPECT_NEAR(rig.far().statistics().one_way_delay, 40e6, 20e3);
    EXPECT_EQ(rig.near().statistics().clock.jumps, 0u);
}

TEST(Endpoint, AFarClockThatIsSetIsNoticed) {
    EndpointRig rig(delayed(40 * ms));
    rig.run(3000 * ms);
    rig.far().set_skew({0, -10'000 * ms, 0.0});
    rig.run(500 * ms);
    EXPECT_EQ(rig.near().statistics().clock.jumps, 1u);
    EXPECT_EQ(rig.near().statistics().clock.offset, -10'000 * ms);
    EXPECT_TRUE(rig.near().connected());
}

TEST(Endpoint, NoiseIsCountedByReason) {
    EndpointRig rig;
    rig.run(100 * ms);
    const auto throw_in = [&](std::span<const std::byte> bytes) { rig.far_wire().send(bytes, rig.now()); };
    std::array<std::byte, max_datagram_bytes> noise{};
    throw_in(noise);
    throw_in(std::span(noise).first(1));
    std::array<std::byte, max_message_bytes> good;
    const std::size_t size = encode({22, 1'000'000, 0}, force(1.0), good);
    throw_in(std::span(good).first(size - 1));
    good[2] = std::byte{99};
    throw_in(std::span(good).first(size));
    rig.run(5 * ms);
    const RefusalCounts& refused = rig.near().statistics().refused;
    EXPECT_EQ(refused.of(Refusal::wrong_magic), 1u);
    EXPECT_EQ(refused.of(Refusal::truncated), 2u);
    EXPECT_EQ(refused.of(Refusal::wrong_version), 1u);
    EXPECT_EQ(refused.total(), 4u);
    EXPECT_TRUE(rig.near_heard().empty());
    EXPECT_TRUE(rig.near().connected());
}

TEST(Endpoint, ItsOwnPacketsComingBackAreStrange) {
    EndpointRig rig;
    rig.run(100 * ms);
    std::array<std::byte, max_message_bytes> own;
    const std::size_t size = encode({11, 1, 0}, Hello{}, own);
    rig.far_wire().send(std::span(own).first(size), rig.now());
    rig.run(5 * ms);
    EXPECT_EQ(rig.near().statistics().strange_epoch, 1u);
    EXPECT_TRUE(rig.near().connected());
}

// --- what others throw in

struct Stranger {
    EndpointRig rig;
    Stranger() { rig.run(300 * ms); }
    void say(const PacketHeader& header, const Message& message) {
        std::array<std::byte, max_message_bytes> bytes;
        const std::size_t size = encode(header, message, bytes);
        ASSERT_GT(size, 0u);
        rig.far_wire().send(std::span(bytes).first(size), rig.now());
    }
    void expect_undisturbed() {
        rig.run(50 * ms);
        rig.near_heard().clear();
        rig.run(100 * ms, [this] { rig.far().send(force(1.0)); });
        EXPECT_TRUE(rig.near().connected());
        EXPECT_EQ(rig.near().peer_epoch(), 22u);
        EXPECT_EQ(rig.near().statistics().peer_hello.side, Side::teleoperator_side);
        EXPECT_EQ(rig.near().statistics().peer_hello.gravity, Hello{}.gravity);
        EXPECT_GE(rig.near_heard().size(), 99u);
    }
};

TEST(Endpoint, AHelloOfTheWrongSideIsNotObeyed) {
    Stranger stranger;
    Hello hello{Side::operator_side};
    hello.gravity = {0.0, 99.0, 0.0};
    for (const std::uint64_t epoch : {std::uint64_t{22}, std::uint64_t{77}}) {
        for (const std::uint64_t heard : {std::uint64_t{0}, std::uint64_t{11}}) {
            hello.heard_epoch = heard;
            stranger.say({epoch, 700 + heard, 0}, hello);
            stranger.expect_undisturbed();
        }
    }
    EXPECT_GE(stranger.rig.near().statistics().implausible, 4u);
}

TEST(Endpoint, AHelloThatDoesNotProveItselfShutsNobodyOut) {
    Stranger stranger;
    Hello hello{Side::teleoperator_side};
    hello.gravity = {0.0, 99.0, 0.0};
    for (std::uint64_t epoch = 100; epoch < 200; ++epoch) {
        stranger.say({epoch, 1, 0}, hello);
    }
    stranger.expect_undisturbed();
    EXPECT_EQ(stranger.rig.near().statistics().peer_restarts, 0u);
}

// While nobody is heard anybody may say hello first; the far side is met again all the same.
TEST(Endpoint, WhoSaysHelloInASilenceKeepsNobodyOut) {
    Stranger stranger;
    LinkConditions nothing;
    nothing.loss = 1.0;
    stranger.rig.near_link().change(nothing);
    stranger.rig.run(1500 * ms);
    EXPECT_EQ(stranger.rig.near().statistics().peer, PeerState::vanished);
    stranger.rig.near_link().change({});
    stranger.say({77, 1, 0}, Hello{Side::teleoperator_side});
    stranger.rig.run(300 * ms);
    stranger.expect_undisturbed();
}

TEST(Endpoint, ASequenceFarAheadKeepsNothingOut) {
    Stranger stranger;
    for (const std::uint64_t sequence : {std::uint64_t{2000}, std::uint64_t{1} << 47, std::uint64_t{600}}) {
        stranger.say({22, sequence, 0}, force(9.0));
        stranger.expect_undisturbed();
    }
    EXPECT_GE(stranger.rig.near().statistics().implausible, 2u);
}

TEST(Endpoint, AByeOfSomebodyElseIsNotTheEnd) {
    Stranger stranger;
    stranger.say({22, 500, 0}, Bye{});
    stranger.rig.run(1500 * ms);
    stranger.expect_undisturbed();
}

// The first packet of an epoch sets the count: one that was wrong holds it up for a second at most.
TEST(Endpoint, AFirstSequenceThatWasWrongIsForgotten) {
    EndpointRig rig;
    rig.stop_far();
    rig.run(100 * ms);
    std::array<std::byte, max_message_bytes> bytes;
    const std::size_t size = encode({22, 1u << 30, 0}, Hello{Side::teleoperator_side}, bytes);
    rig.far_wire().send(std::span(bytes).first(size), rig.now());
    rig.start_far(22);
    rig.run(1500 * ms);
    EXPECT_TRUE(rig.near().connected());
}

TEST(Endpoint, KnowsWhatIsLostOnTheWayThere) {
    LinkConditions conditions;
    conditions.loss = 0.2;
    EndpointRig rig(conditions);
    rig.run(8000 * ms, [&] { rig.far().send(force(1.0)); });
    EXPECT_NEAR(rig.far().statistics().lost_there, 0.2, 0.08);
    EXPECT_GT(rig.near().statistics().received_rate.bits_per_s, 8.0 * 800 * (28 + 30));
}

TEST(Endpoint, WhatCannotBeSentIsCounted) {
    EndpointRig rig;
    rig.run(10 * ms);
    EXPECT_FALSE(rig.near().send(force(std::numeric_limits<double>::infinity())));
    EXPECT_EQ(rig.near().statistics().not_sent, 1u);
}

TEST(Endpoint, RatesAreThoseOfTheLastSecond) {
    EndpointRig rig;
    rig.run(100 * ms);
    rig.run(3000 * ms, [&] { rig.far().send(force(1.0)); });
    EXPECT_NEAR(rig.far().statistics().sent_rate.packets, 1030.0, 5.0);
    EXPECT_NEAR(rig.near().statistics().received_rate.packets, 1030.0, 5.0);
    rig.run(2500 * ms);
    EXPECT_NEAR(rig.near().statistics().received_rate.packets, 30.0, 1.0);
    EXPECT_GT(rig.near().statistics().received_rate.bytes, 1000.0);
}

TEST(Endpoint, AFloodIsSpreadOverTicks) {
    EndpointRig rig;
    rig.run(100 * ms);
    for (int i = 0; i < 1000; ++i) {
        rig.far().send(force(i));
    }
    rig.run(1 * ms);
    EXPECT_LE(rig.near_heard().size(), static_cast<std::size_t>(Endpoint::max_datagrams_per_tick));
    rig.run(10 * ms);
    EXPECT_EQ(rig.near_heard().size(), 1000u);
}

TEST(Endpoint, ATickAllocatesLocksAndAsksForNothing) {
    MemoryLinkPair pair;
    LinkEmulator near_link(pair.first(), delayed(3 * ms), 1);
    LinkEmulator far_link(pair.second(), delayed(3 * ms), 2);
    EndpointSettings settings;
    Endpoint near(near_link, settings);
    settings.side = Side::teleoperator_side;
    settings.epoch = 2;
    Endpoint far(far_link, settings);
    const std::vector<Message> messages = samples::one_of_each();
    int received = 0;
    testing::AuditScope audit;
    for (Nanoseconds now = 0; now < 2000 * ms; now += ms) {
        for (Endpoint* side : {&near, &far}) {
            side->begin_tick(now);
            while (side->receive() != nullptr) {
                ++received;
            }
            side->send(messages[7]);
            side->send(messages[8]);
            side->end_tick();
        }
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees() + audit.locks() + audit.waits() + audit.system_calls(), 0u)
        << audit.describe();
    EXPECT_GT(received, 7000);
}

TEST(SequenceWindow, TellsFirstsFromCopies) {
    using Arrival = SequenceWindow::Arrival;
    SequenceWindow window;
    EXPECT_EQ(window.note(100), Arrival::newest);
    EXPECT_EQ(window.note(100), Arrival::copy);
    EXPECT_EQ(window.note(103), Arrival::newest);
    EXPECT_EQ(window.missing(), 2u);
    EXPECT_EQ(window.note(101), Arrival::late);
    EXPECT_EQ(window.note(101), Arrival::copy);
    EXPECT_EQ(window.missing(), 1u);
    EXPECT_EQ(window.note(99), Arrival::late) << "sent before the first one that came";
    EXPECT_EQ(window.missing(), 1u);
}

TEST(SequenceWindow, ReachesExactlyItsLength) {
    using Arrival = SequenceWindow::Arrival;
    SequenceWindow window;
    window.note(5000);
    EXPECT_EQ(window.note(5000 - SequenceWindow::length), Arrival::too_old);
    EXPECT_EQ(window.note(5001 - SequenceWindow::length), Arrival::late);
    window.note(5000 + 3 * SequenceWindow::length);
    EXPECT_EQ(window.note(4999 + 3 * SequenceWindow::length), Arrival::late) << "a long gap clears what was";
    EXPECT_EQ(window.missing(), 3 * SequenceWindow::length - 2);
}

TEST(SequenceWindow, WhatIsOvertakenIsCountedWhereItIsSettled) {
    SequenceWindow window;
    EXPECT_EQ(window.settled().sequence, 0u);
    window.note(1);  // from where all are counted
    std::uint64_t lost = 0;
    for (std::uint64_t sequence = 1; sequence <= 10'000; sequence += 10) {
        // Ten in the reverse order, of which each third ten have lost one.
        for (std::uint64_t back = 10; back-- > 0;) {
            const bool is_lost = back == 4 && sequence % 30 == 1;
            if (!is_lost) {
                window.note(sequence + back);
            }
        }
        const SequenceWindow::Settled settled = window.settled();
        if (settled.sequence > 0) {
            lost = settled.sequence - settled.packets;
            EXPECT_EQ(lost, (settled.sequence + 25) / 30) << settled.sequence;
        }
    }
    EXPECT_GT(lost, 300u);
}

TEST(SequenceWindow, AgreesWithASetThroughDisorder) {
    SequenceWindow window;
    std::vector<bool> came(6000, false);
    std::uint64_t state = 1;
    std::uint64_t base = 1;
    for (int i = 0; i < 20'000; ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        base = std::min<std::uint64_t>(base + (state >> 62), 5000);
        const std::uint64_t sequence = base + (state >> 40) % 900;
        const SequenceWindow::Arrival arrival = window.note(sequence);
        ASSERT_EQ(arrival == SequenceWindow::Arrival::copy, came[sequence]) << sequence;
        came[sequence] = true;
    }
}

TEST(RandomEpoch, IsAnotherOneEachTime) {
    EXPECT_NE(random_epoch(), random_epoch());
    EXPECT_NE(random_epoch(), 0u);
}

}  // namespace
}  // namespace tactus::endpoint_test
