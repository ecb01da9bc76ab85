// Packets survive the wire to the bit, and whatever else arrives is refused with its reason.
#include "network/messages.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <map>
#include <string>

#include "published_vectors.hpp"
#include "shared/random_values.hpp"
#include "wire_samples.hpp"

namespace tactus {
namespace {

using Bytes = std::vector<std::byte>;

Bytes encoded(const Message& message, const PacketHeader& header = samples::header) {
    Bytes bytes(most_message_bytes);
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

INSTANTIATE_TEST_SUITE_P(Messages, EveryKind, ::testing::Range(std::size_t{0}, std::variant_size_v<Message>));

TEST_P(EveryKind, SurvivesTheWire) {
    EXPECT_EQ(message().index(), GetParam());
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

TEST_P(EveryKind, IsRefusedWithABodyThatEndsTooSoon) {
    Bytes bytes = encoded(message());
    std::uint16_t body = 0;
    std::memcpy(&body, &bytes[4], 2);
    for (std::uint16_t shorter = 0; shorter < body; ++shorter) {
        Bytes cut(bytes.begin(), bytes.begin() + 32 + shorter);
        std::memcpy(&cut[4], &shorter, 2);
        EXPECT_NE(refusal_of(cut), Refusal::none) << shorter << " bytes of body";
    }
}

TEST_P(EveryKind, IsRefusedWithBytesAfterIt) {
    Bytes bytes = encoded(message());
    bytes.push_back(std::byte{0});
    EXPECT_EQ(refusal_of(bytes), Refusal::oversized);
    std::uint16_t body = 0;
    std::memcpy(&body, &bytes[4], 2);
    ++body;
    std::memcpy(&bytes[4], &body, 2);
    EXPECT_NE(refusal_of(bytes), Refusal::none);
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
    for (std::size_t at = 32; at + 8 <= whole.size(); ++at) {
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

// Whatever a damaged packet decodes to can be encoded again, to the same bytes: nothing was misread.
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
            bytes.resize(static_cast<std::size_t>(random.below(static_cast<int>(most_datagram_bytes))));
        }
        Packet packet;
        if (decode(bytes, packet) == Refusal::none) {
            EXPECT_EQ(encoded(packet.message, packet.header), bytes);
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
    EXPECT_EQ(refusal_of(with(3, 11)), Refusal::unknown_type);
    EXPECT_EQ(refusal_of(with(6, 1)), Refusal::out_of_range) << "reserved bytes are zero";
    EXPECT_EQ(refusal_of(Bytes(most_message_bytes + 1)), Refusal::wrong_magic);
    Bytes long_one = good;
    long_one.resize(most_message_bytes + 1);
    EXPECT_EQ(refusal_of(long_one), Refusal::oversized);
}

TEST(Messages, AHeaderWithoutEpochOrSequenceIsRefused) {
    EXPECT_TRUE(encoded(Bye{}, {0, 1, 0}).empty());
    EXPECT_TRUE(encoded(Bye{}, {1, 0, 0}).empty());
    Bytes bytes = encoded(Bye{});
    std::memset(&bytes[8], 0, 8);
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
    EXPECT_TRUE(encoded(ForceSample{0, 0, 0, {0.0, nan, 0.0}, {}, no_object}).empty());
    EXPECT_TRUE(encoded(ForceSample{0, 0, 0, {0.0, infinity, 0.0}, {}, no_object}).empty());
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
    ObjectStates states{0, 0, ObjectStates::most, {}};
    for (std::size_t i = 0; i < ObjectStates::most; ++i) {
        states.states[i] = samples::state(static_cast<ObjectId>(i));
    }
    expect_round_trip(states);
    OperatorSamples hands{OperatorSamples::most, {}};
    for (std::size_t i = 0; i < OperatorSamples::most; ++i) {
        hands.samples[i] = samples::hand(i + 1);
    }
    expect_round_trip(hands);
    const Bytes piece(most_fragment_bytes);
    expect_round_trip(DiscoveryFragment{1, 1, samples::hash(), most_description_bytes, 0, piece});
}

TEST(Messages, CountsBeyondTheLimitAreRefused) {
    ObjectStates states{0, 0, ObjectStates::most + 1, {}};
    EXPECT_TRUE(encoded(states).empty());
    EXPECT_TRUE(encoded(OperatorSamples{}).empty());
}

TEST(Messages, AFragmentThatIsNotWhereItSaysIsRefused) {
    const Bytes piece(most_fragment_bytes);
    const auto fragment = [&](std::uint32_t total, std::uint32_t offset, std::size_t size) {
        return encoded(DiscoveryFragment{1, 1, samples::hash(), total, offset, std::span(piece).first(size)});
    };
    EXPECT_FALSE(fragment(2048, 1024, 1024).empty());
    EXPECT_TRUE(fragment(2048, 2048, 0).empty()) << "behind the end";
    EXPECT_TRUE(fragment(2048, 512, 1024).empty()) << "not on a multiple";
    EXPECT_TRUE(fragment(2048, 1024, 1000).empty()) << "shorter than its place";
    EXPECT_TRUE(fragment(1000, 0, 1024).empty()) << "longer than the whole";
    EXPECT_TRUE(fragment(0, 0, 0).empty());
    EXPECT_TRUE(fragment(most_description_bytes + 1, 0, 1024).empty());
}

// The bytes that docs/wire_format.md describes, for a second implementation to read: tests/tools reads them.
TEST(Messages, AreTheBytesOfThePublishedVectors) {
    std::map<std::string, std::string> published = samples::published_vectors();
    const char* names[] = {
        "hello",   "bye",         "clock_request", "clock_answer",     "discovery_fragment",
        "removal", "acknowledge", "object_states", "operator_samples", "force"};
    const std::vector<Message> messages = samples::one_of_each();
    for (std::size_t i = 0; i < messages.size(); ++i) {
        EXPECT_EQ(published[names[i]], samples::hex(encoded(messages[i]))) << names[i];
    }
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
}  // namespace tactus
