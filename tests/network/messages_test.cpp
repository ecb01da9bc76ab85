// Packets survive the wire to the bit, and whatever else arrives is refused with its reason.
#include "network/messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <map>
#include <string>

#include "network/plausibility.hpp"
#include "published_vectors.hpp"
#include "shared/random_values.hpp"
#include "shared/wire_samples.hpp"

namespace tactus::messages_test {
namespace {

using Bytes = std::vector<std::byte>;

Bytes encoded(const Message& message, const PacketHeader& header = samples::header) {
    Bytes bytes(max_message_bytes);
    bytes.resize(encode(header, message, bytes));
    return bytes;
}

Refusal refusal_of(const Bytes& bytes) {
    Packet packet;
    return decode(bytes, packet);
}

// Two messages are the same when their bytes are.
void expect_round_trip(const Message& message) {
    const Bytes bytes = encoded(message);
    ASSERT_FALSE(bytes.empty());
    Packet packet;
    ASSERT_EQ(decode(bytes, packet), Refusal::none);
    EXPECT_EQ(packet.header.epoch, samples::header.epoch);
    EXPECT_EQ(packet.header.sequence, samples::header.sequence);
    EXPECT_EQ(packet.header.sent_at, samples::header.sent_at);
    EXPECT_EQ(packet.message.index(), message.index());
    EXPECT_EQ(encoded(packet.message, packet.header), bytes);
}

class EveryKind : public ::testing::TestWithParam<std::size_t> {
protected:
    Message message() const { return samples::one_of_each()[GetParam()]; }
};

INSTANTIATE_TEST_SUITE_P(Messages, EveryKind,
                         ::testing::Range(std::size_t{0}, samples::one_of_each().size()));

TEST_P(EveryKind, SurvivesTheWire) {
    const std::size_t kinds = std::variant_size_v<Message>;
    EXPECT_EQ(message().index(), GetParam() < kinds ? GetParam() : Message(OperatorSamples{}).index());
    expect_round_trip(message());
}

TEST_P(EveryKind, IsRefusedWhenCutAtAnyByte) {
    const Bytes whole = encoded(message());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        EXPECT_EQ(refusal_of(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
                  Refusal::truncated)
            << size << " bytes";
    }
}

TEST_P(EveryKind, IsRefusedWithBytesAfterIt) {
    Bytes bytes = encoded(message());
    bytes.push_back(std::byte{0});
    EXPECT_EQ(refusal_of(bytes), Refusal::oversized);
}

// What a later version adds is passed over; what only looks like it is not.
TEST_P(EveryKind, CarriesExtensionsThatNobodyKnows) {
    Bytes bytes = encoded(message());
    for (const int byte : {7, 2, 99, 99, 8, 0}) {
        bytes.push_back(static_cast<std::byte>(byte));
    }
    EXPECT_EQ(refusal_of(bytes), Refusal::none);
    bytes.push_back(std::byte{9});
    EXPECT_EQ(refusal_of(bytes), Refusal::truncated);
    bytes.push_back(std::byte{1});
    EXPECT_EQ(refusal_of(bytes), Refusal::truncated);
}

TEST_P(EveryKind, IsRefusedFromAnotherVersion) {
    Bytes bytes = encoded(message());
    bytes[2] = std::byte{wire_version + 1};
    EXPECT_EQ(refusal_of(bytes), Refusal::wrong_version);
}

// Eight bytes of ones are a NaN wherever a real number stands, and out of range wherever a time does.
TEST_P(EveryKind, NeverLetsANanThrough) {
    const Bytes whole = encoded(message());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t at = 4; at + 8 <= whole.size(); ++at) {
        Bytes bytes = whole;
        std::memcpy(&bytes[at], &nan, 8);
        Packet packet;
        if (decode(bytes, packet) == Refusal::none) {
            // Then it was no real number; what came out must be one that may be sent again.
            EXPECT_FALSE(encoded(packet.message, packet.header).empty()) << "at byte " << at;
        }
    }
}

TEST_P(EveryKind, DoesNotFitIntoLessRoomThanItNeeds) {
    const std::size_t size = encoded(message()).size();
    Bytes room(size);
    EXPECT_EQ(encode(samples::header, message(), room), size);
    for (std::size_t less = 0; less < size; ++less) {
        EXPECT_EQ(encode(samples::header, message(), std::span(room).first(less)), 0u);
    }
}

// Whatever a damaged packet decodes to can be encoded again and says the same then: nothing was misread, and
// nothing gets past the reader that the writer would not let out.
TEST_P(EveryKind, SurvivesDamageOrIsRefused) {
    const Bytes whole = encoded(message());
    shared::RandomValues random(GetParam() + 1);
    for (int round = 0; round < 20'000; ++round) {
        Bytes bytes = whole;
        for (int hits = 1 + random.below(4); hits > 0; --hits) {
            bytes[static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())))] =
                static_cast<std::byte>(random.below(256));
        }
        if (random.below(8) == 0) {
            bytes.resize(static_cast<std::size_t>(random.below(static_cast<int>(max_datagram_bytes))));
        }
        Packet packet;
        if (decode(bytes, packet) == Refusal::none) {
            const Bytes again = encoded(packet.message, packet.header);
            ASSERT_FALSE(again.empty());
            Packet second;
            ASSERT_EQ(decode(again, second), Refusal::none);
            EXPECT_EQ(encoded(second.message, second.header), again);
        }
    }
}

TEST(Messages, NoiseIsRefused) {
    shared::RandomValues random(5);
    for (int round = 0; round < 100'000; ++round) {
        Bytes bytes(static_cast<std::size_t>(random.below(200)));
        for (std::byte& byte : bytes) {
            byte = static_cast<std::byte>(random.below(256));
        }
        EXPECT_NE(refusal_of(bytes), Refusal::none);
    }
}

TEST(Messages, EveryRefusalHasItsReason) {
    const Bytes good = encoded(ClockRequest{1, 2});
    const auto with = [&good](std::size_t at, int value) {
        Bytes bytes = good;
        bytes[at] = static_cast<std::byte>(value);
        return bytes;
    };
    EXPECT_EQ(refusal_of(with(0, 'X')), Refusal::wrong_magic);
    EXPECT_EQ(refusal_of(with(1, 'S')), Refusal::sealed);
    EXPECT_EQ(refusal_of(with(2, 0)), Refusal::wrong_version);
    EXPECT_EQ(refusal_of(with(3, 0)), Refusal::unknown_type);
    constexpr int one_too_many = static_cast<int>(std::variant_size_v<Message>) + 1;
    EXPECT_EQ(refusal_of(with(3, one_too_many)), Refusal::unknown_type);
    EXPECT_EQ(refusal_of(Bytes(max_message_bytes + 1)), Refusal::wrong_magic);
    Bytes long_one = good;
    long_one.resize(max_message_bytes + 1);
    EXPECT_EQ(refusal_of(long_one), Refusal::oversized);
}

TEST(Messages, AHeaderWithoutEpochOrSequenceIsRefused) {
    EXPECT_TRUE(encoded(Bye{}, {0, 1, 0}).empty());
    EXPECT_TRUE(encoded(Bye{}, {1, 0, 0}).empty());
    Bytes bytes = encoded(Bye{});
    std::memset(&bytes[4], 0, 8);
    EXPECT_EQ(refusal_of(bytes), Refusal::out_of_range);
}

TEST(Messages, TimesAreBoundedSoThatSumsCannotOverflow) {
    EXPECT_FALSE(encoded(ClockRequest{1, Nanoseconds{1} << 60}).empty());
    EXPECT_TRUE(encoded(ClockRequest{1, (Nanoseconds{1} << 60) + 1}).empty());
    Bytes bytes = encoded(ClockRequest{1, 0});
    const Nanoseconds huge = std::numeric_limits<Nanoseconds>::min();
    std::memcpy(&bytes[bytes.size() - 8], &huge, 8);
    EXPECT_EQ(refusal_of(bytes), Refusal::out_of_range);
}

TEST(Messages, ANanIsNotSent) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double newtons : {nan, infinity, 2.0 * plausible::max_force}) {
        EXPECT_TRUE(encoded(samples::force(newtons)).empty());
    }
}

TEST(Messages, ARotationHasUnitLength) {
    ObjectStates states{0, 0, 1, {}};
    states.states[0] = samples::state(1);
    states.states[0].pose.rotation = Quat(0.0, 0.0, 0.0, 0.0);
    EXPECT_TRUE(encoded(states).empty());
    states.states[0].pose.rotation = Quat(1.0, 0.1, 0.0, 0.0);
    EXPECT_TRUE(encoded(states).empty());
    states.states[0].pose.rotation = Quat(1.0, 1e-5, 0.0, 0.0);
    EXPECT_FALSE(encoded(states).empty());
}

TEST(Messages, TheFullestMessagesFit) {
    ObjectStates states{0, 0, ObjectStates::max_count, {}};
    for (std::size_t i = 0; i < ObjectStates::max_count; ++i) {
        states.states[i] = samples::state(static_cast<ObjectId>(i));
    }
    expect_round_trip(states);
    OperatorSamples hands{1'000'000, OperatorSamples::max_count, {}};
    for (std::size_t i = 0; i < OperatorSamples::max_count; ++i) {
        hands.samples[i] = samples::hand(OperatorSamples::max_count - i);
    }
    expect_round_trip(hands);
    ForceSamples forces{ForceSamples::max_count, {}};
    expect_round_trip(forces);
    const Bytes piece(max_fragment_bytes);
    expect_round_trip(DiscoveryFragment{1, 1, samples::hash(), max_description_bytes, 0, piece});
}

TEST(Messages, CountsBeyondTheLimitAreRefused) {
    ObjectStates states{0, 0, ObjectStates::max_count + 1, {}};
    EXPECT_TRUE(encoded(states).empty());
    EXPECT_TRUE(encoded(OperatorSamples{}).empty());
}

TEST(Messages, AFragmentThatIsNotWhereItSaysIsRefused) {
    const Bytes piece(max_fragment_bytes);
    const auto fragment = [&](std::uint32_t total, std::uint32_t offset, std::size_t size) {
        return encoded(DiscoveryFragment{1, 1, samples::hash(), total, offset, std::span(piece).first(size)});
    };
    EXPECT_FALSE(fragment(2048, 1024, 1024).empty());
    EXPECT_TRUE(fragment(2048, 2048, 0).empty()) << "behind the end";
    EXPECT_TRUE(fragment(2048, 512, 1024).empty()) << "not on a multiple";
    EXPECT_TRUE(fragment(2048, 1024, 1000).empty()) << "shorter than its place";
    EXPECT_TRUE(fragment(1000, 0, 1024).empty()) << "longer than the whole";
    EXPECT_TRUE(fragment(0, 0, 0).empty());
    EXPECT_TRUE(fragment(max_description_bytes + 1, 0, 1024).empty());
}

// The bytes that docs/wire_format.md describes, for a second implementation to read: tests/tools reads them.
TEST(Messages, AreTheBytesOfThePublishedVectors) {
    std::map<std::string, std::string> published = samples::published_vectors();
    const char* names[] = {"hello",
                           "bye",
                           "clock_request",
                           "clock_answer",
                           "discovery_fragment",
                           "removal",
                           "acknowledge",
                           "object_states",
                           "operator_samples",
                           "forces",
                           "ghosts",
                           "estimates",
                           "wrenches",
                           "sample_acknowledgements",
                           "terms",
                           "tool_samples"};
    const std::vector<Message> messages = samples::one_of_each();
    for (std::size_t i = 0; i < messages.size(); ++i) {
        EXPECT_EQ(published[names[i]], samples::hex(encoded(messages[i]))) << names[i];
    }
}

// Who does not know it passes over it: it is behind the last field.
TEST(Messages, ForcesTellEnergyInAnExtension) {
    ForceSamples forces = samples::force(2.0);
    const Bytes without = encoded(forces);
    forces.samples[0].taken = told_energy(12.5);
    const Bytes with = encoded(forces);
    ASSERT_EQ(with.size(), without.size() + 2 + sizeof(std::uint32_t));
    EXPECT_TRUE(std::equal(without.begin(), without.end(), with.begin()));
    Packet packet;
    ASSERT_EQ(decode(with, packet), Refusal::none);
    EXPECT_EQ(std::get<ForceSamples>(packet.message).samples[0].taken, 125'000'000u);
    ASSERT_EQ(decode(without, packet), Refusal::none);
    EXPECT_EQ(std::get<ForceSamples>(packet.message).samples[0].taken, 0u);
}

TEST(Messages, AnOlderReaderHearsAllThatItKnows) {
    for (const Message& message : samples::one_of_each()) {
        const bool is_new =
            std::holds_alternative<Terms>(message) || std::holds_alternative<SampleAcknowledgements>(message);
        EXPECT_EQ(encoded(message)[2], std::byte{static_cast<unsigned char>(is_new ? 4 : 3)});
    }
}

// --- what no honest side says

TEST(Messages, AHandOutOfThisWorldIsRefused) {
    for (const double metres : {1e9, 1.01e5}) {
        OperatorSamples hands{1'000'000, 1, {}};
        hands.samples[0] = samples::hand(1);
        hands.samples[0].position.y = metres;
        EXPECT_TRUE(encoded(hands).empty()) << metres;
    }
    for (const double speed : {1e9, 1001.0}) {
        OperatorSamples hands{1'000'000, 1, {}};
        hands.samples[0] = samples::hand(1);
        hands.samples[0].velocity.y = speed;
        EXPECT_TRUE(encoded(hands).empty()) << speed;
    }
}

// --- tools

// Also where two parts are the largest, but for rounding.
TEST(Messages, ATurnIsRoundedOnce) {
    shared::RandomValues random(7);
    for (int i = 0; i < 20'000; ++i) {
        const double share = i % 2 == 0 ? 1e-9 * random.between(-1.0, 1.0) : random.between(-1.0, 1.0);
        const Quat turn = glm::normalize(Quat(1.0, 1.0 + share, random.between(-1.0, 1.0) * share,
                                              i % 3 == 0 ? -1.0 : random.between(-1.0, 1.0)));
        const Quat sent = rotation_as_sent(turn);
        EXPECT_LT(std::min(glm::length(sent - turn), glm::length(sent + turn)), 2e-9);
        const Quat again = rotation_as_sent(sent);
        EXPECT_TRUE(again == sent) << i;
        OperatorSamples hands{1'000'000, 1, {}};
        hands.samples[0] = samples::tool(1);
        hands.samples[0].rotation = sent;
        Packet packet;
        ASSERT_EQ(decode(encoded(hands), packet), Refusal::none);
        EXPECT_TRUE(std::get<OperatorSamples>(packet.message).samples[0].rotation == sent) << i;
    }
}

TEST(Messages, ATurnThatIsNoneOrTooFastIsRefused) {
    const auto says = [](const Quat& rotation, const Vec3& spin) {
        OperatorSamples hands{1'000'000, 1, {}};
        hands.samples[0] = samples::tool(1);
        hands.samples[0].rotation = rotation;
        hands.samples[0].spin = spin;
        return !encoded(hands).empty();
    };
    const Quat none(1.0, 0.0, 0.0, 0.0);
    EXPECT_TRUE(says(none, Vec3(0.0)));
    EXPECT_FALSE(says(Quat(0.0, 0.0, 0.0, 0.0), Vec3(0.0)));
    EXPECT_FALSE(says(Quat(1.1, 0.0, 0.0, 0.0), Vec3(0.0)));
    EXPECT_FALSE(says(Quat(std::nan(""), 0.0, 0.0, 0.0), Vec3(0.0)));
    EXPECT_FALSE(says(none, {0.0, 1.1e4, 0.0}));
    EXPECT_FALSE(says(none, {0.0, std::numeric_limits<double>::infinity(), 0.0}));
    WrenchSamples wrench{1, {}};
    EXPECT_FALSE(encoded(wrench).empty());
    wrench.samples[0].torque.z = -1001.0;
    EXPECT_TRUE(encoded(wrench).empty());
}

// With two repeats: the turn and how it goes on take 14 bytes a sample more.
TEST(Messages, AHandWithAToolTakesFewBytes) {
    std::size_t bytes = 0;
    constexpr int ticks = 1000;
    const auto at = [](std::uint64_t tick) {
        OperatorSample sample;
        const double t = 1e-3 * static_cast<double>(tick);
        sample.sequence = tick;
        sample.time = static_cast<Nanoseconds>(tick) * 1'000'000;
        sample.pointer = first_tool;
        sample.connected = sample.has_turn = true;
        sample.position = {0.1 * std::sin(3.0 * t), 0.05 * std::cos(2.0 * t), 0.0};
        sample.velocity = {0.3 * std::cos(3.0 * t), -0.1 * std::sin(2.0 * t), 0.0};
        sample.rotation = glm::angleAxis(0.5 * std::sin(2.0 * t), glm::normalize(Vec3(1.0, 2.0, 0.5)));
        sample.spin = glm::normalize(Vec3(1.0, 2.0, 0.5)) * std::cos(2.0 * t);
        return sample;
    };
    for (std::uint64_t tick = 3; tick < 3 + ticks; ++tick) {
        OperatorSamples hands{1'000'000, 3, {}};
        for (std::uint64_t i = 0; i < 3; ++i) {
            hands.samples[i] = at(tick - i);
        }
        bytes +=
            encoded(hands, {0x0102030405060708u, tick, static_cast<Nanoseconds>(tick) * 1'000'000}).size();
    }
    EXPECT_LT(bytes, 130u * ticks);
}

TEST(Messages, AGravityOfNoPlanetIsRefused) {
    Hello hello;
    hello.gravity.y = -1e5;
    EXPECT_TRUE(encoded(hello).empty());
    Bytes bytes = encoded(Hello{});
    const double strong = -1e5, usual = -9.81;
    const auto at = std::search(bytes.begin(), bytes.end(), reinterpret_cast<const std::byte*>(&usual),
                                reinterpret_cast<const std::byte*>(&usual) + sizeof usual);
    ASSERT_NE(at, bytes.end());
    std::memcpy(&*at, &strong, sizeof strong);
    EXPECT_EQ(refusal_of(bytes), Refusal::out_of_range);
}

TEST(Messages, WhatWasTrueLongAgoOrWillBeIsRefused) {
    for (const Nanoseconds age : {plausible::max_age + 1, -plausible::max_age - 1, plausible::max_time / 2}) {
        EXPECT_TRUE(encoded(ObjectStates{samples::header.sent_at - age, 0, 0, {}}).empty());
    }
    EXPECT_TRUE(encoded(Bye{}, {1, plausible::max_sequence + 1, 0}).empty());
    OperatorSamples hands{1'000'000, 1, {}};
    hands.samples[0] = samples::hand(~std::uint64_t{0});
    EXPECT_TRUE(encoded(hands).empty());
}

// A full second of one hand, with two repeats in every packet, on its way in IPv4 and UDP.
TEST(Messages, AHandTakesFewBytes) {
    std::size_t bytes = 0;
    for (std::uint64_t tick = 3; tick < 1003; ++tick) {
        OperatorSamples hands{1'000'000, 3, {}};
        for (std::uint64_t i = 0; i < 3; ++i) {
            const double t = 1e-3 * static_cast<double>(tick - i);
            OperatorSample& hand = hands.samples[i];
            hand = {tick - i,
                    static_cast<Nanoseconds>(1'000'000 * (tick - i)),
                    0,
                    true,
                    0,
                    {0.2 * std::sin(6.0 * t), 0.1 * std::cos(5.0 * t), 0.1 * std::sin(7.0 * t)},
                    {1.2 * std::cos(6.0 * t), -0.5 * std::sin(5.0 * t), 0.7 * std::cos(7.0 * t)},
                    {3.0 * std::sin(9.0 * t), 5.0 * std::cos(9.0 * t), std::sin(20.0 * t)},
                    no_object,
                    Vec3(0.0)};
        }
        bytes += encoded(hands, {~std::uint64_t{0}, 1'000'000 + tick, hands.samples[0].time}).size() + 28;
    }
    EXPECT_LT(8.0 * static_cast<double>(bytes), 1.25e6);
}

TEST(Messages, WhatIsRoundedIsRoundedToLessThanANanometer) {
    Packet packet;
    ObjectStates states{0, 1, 1, {}};
    states.states[0] = samples::state(3);
    states.states[0].pose.position = {0.123456789123, -4567.89, 1e-10};
    const Bytes bytes = encoded(states);
    ASSERT_EQ(decode(bytes, packet), Refusal::none);
    const ObjectState& read = std::get<ObjectStates>(packet.message).states[0];
    EXPECT_LE(glm::distance(read.pose.position, states.states[0].pose.position), 1e-9);
    EXPECT_GT(std::abs(glm::dot(read.pose.rotation, states.states[0].pose.rotation)), 1.0 - 1e-15);
    EXPECT_NEAR(glm::distance(read.linear_velocity, states.states[0].linear_velocity), 0.0, 1e-6);
}

TEST(RefusalCounts, AddUp) {
    RefusalCounts counts;
    counts.add(Refusal::none);
    counts.add(Refusal::truncated);
    counts.add(Refusal::truncated);
    counts.add(Refusal::not_finite);
    EXPECT_EQ(counts.of(Refusal::truncated), 2u);
    EXPECT_EQ(counts.total(), 3u);
}

}  // namespace
}  // namespace tactus::messages_test
