#include "devices/falcon/falcon_packet.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "shared/random_values.hpp"

namespace tactus::falcon_packet_test {
namespace {

FalconReport random_report(shared::RandomValues& random) {
    FalconReport report;
    for (std::int16_t& encoder : report.encoders) {
        encoder = static_cast<std::int16_t>(random.below(65'536) - 32'768);
    }
    report.buttons = static_cast<std::uint8_t>(random.below(16));
    report.homed = static_cast<std::uint8_t>(random.below(8));
    return report;
}

TEST(FalconPacket, NibblesComeLowestFirst) {
    FalconCommand command;
    command.torques = {0x1234, -1, 0};
    command.homing = true;
    command.leds = falcon_led_blue;
    const FalconPacket packet = falcon_encode(command);
    EXPECT_EQ(std::string(packet.begin(), packet.end()), "<EDCBPPPPAAAAFA>");
}

TEST(FalconPacket, WhatIsSentInPiecesComesOutWhole) {
    shared::RandomValues random(1);
    FalconStream<FalconReport> stream;
    std::vector<FalconReport> sent, got;
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 1'000; ++i) {
        sent.push_back(random_report(random));
        const FalconPacket packet = falcon_encode(sent.back());
        bytes.insert(bytes.end(), packet.begin(), packet.end());
    }
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t size =
            std::min<std::size_t>(1 + static_cast<std::size_t>(random.below(62)), bytes.size() - at);
        stream.take(std::span(bytes).subspan(at, size));
        at += size;
        for (FalconReport report; stream.next(report);) {
            got.push_back(report);
        }
    }
    EXPECT_EQ(sent, got);
    EXPECT_EQ(stream.dropped(), 0u);
}

// Bytes are lost and made up: never more than the packets that they were in are lost, and none is invented.
TEST(FalconPacket, FindsTheNextWholePacketAfterWhateverIsMissing) {
    shared::RandomValues random(2);
    for (int round = 0; round < 2'000; ++round) {
        FalconStream<FalconReport> stream;
        const FalconReport first = random_report(random), second = random_report(random);
        const FalconPacket whole = falcon_encode(first);
        std::vector<std::uint8_t> bytes(whole.begin(), whole.begin() + random.below(16));
        if (random.flip()) {
            bytes.push_back(static_cast<std::uint8_t>(random.below(256)));
        }
        const FalconPacket next = falcon_encode(second);
        bytes.insert(bytes.end(), next.begin(), next.end());
        bytes.insert(bytes.end(), next.begin(), next.end());
        stream.take(bytes);
        FalconReport report;
        bool found = false;
        while (stream.next(report)) {
            EXPECT_EQ(report, second);
            found = true;
        }
        EXPECT_TRUE(found);
    }
}

}  // namespace
}  // namespace tactus::falcon_packet_test
