#include "sensing/recording/depth_codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "shared/oni_writer.hpp"
#include "shared/random_values.hpp"

namespace tactus::depth_codec_test {
namespace {

constexpr std::array all_codecs{DepthCodec::none, DepthCodec::differences, DepthCodec::indices};

// Flat for a while, or with small, larger and large jumps.
std::vector<std::uint16_t> random_image(shared::RandomValues& chance, std::size_t count) {
    std::vector<std::uint16_t> pixels(count);
    int depth = 900;
    for (std::uint16_t& pixel : pixels) {
        const int kind = chance.below(8);
        depth = kind == 0   ? chance.below(10000)
                : kind == 1 ? depth - 50
                : kind < 5  ? depth
                            : depth + chance.below(4);
        depth = std::clamp(depth, 0, 10000);
        pixel = static_cast<std::uint16_t>(depth);
    }
    return pixels;
}

TEST(DepthCodec, WhatWasEncodedIsDecoded) {
    shared::RandomValues chance(1);
    for (const DepthCodec codec : all_codecs) {
        for (const std::size_t count : {1u, 2u, 3u, 31u, 32u, 33u, 500u, 5000u}) {
            const std::vector<std::uint16_t> pixels = random_image(chance, count);
            std::vector<std::uint16_t> read(count, 7);
            ASSERT_EQ(decode_depth(codec, shared::encode_depth(codec, pixels), read), count);
            EXPECT_EQ(read, pixels);
        }
    }
}

TEST(DepthCodec, AFlatImageIsShort) {
    const std::vector<std::uint16_t> pixels(3200, 850);
    const auto bytes = shared::encode_depth(DepthCodec::differences, pixels);
    EXPECT_LT(bytes.size(), 120u);
    std::vector<std::uint16_t> read(pixels.size());
    EXPECT_EQ(decode_depth(DepthCodec::differences, bytes, read), pixels.size());
    EXPECT_EQ(read, pixels);
}

TEST(DepthCodec, MorePixelsThanThereIsRoomForAreRefused) {
    shared::RandomValues chance(2);
    const std::vector<std::uint16_t> pixels = random_image(chance, 500);
    std::vector<std::uint16_t> small(499);
    for (const DepthCodec codec : {DepthCodec::differences, DepthCodec::indices}) {
        EXPECT_EQ(decode_depth(codec, shared::encode_depth(codec, pixels), small), 0u);
    }
    std::vector<std::uint16_t> large(501);
    EXPECT_EQ(decode_depth(DepthCodec::none, shared::encode_depth(DepthCodec::none, pixels), large), 0u);
}

TEST(DepthCodec, WhatEndsEarlyFillsTheBeginning) {
    const std::vector<std::uint16_t> pixels(100, 850);
    std::vector<std::uint16_t> read(120, 7);
    ASSERT_EQ(
        decode_depth(DepthCodec::differences, shared::encode_depth(DepthCodec::differences, pixels), read),
        100u);
    EXPECT_EQ(read[99], 850);
    EXPECT_EQ(read[100], 7);
}

// Indices beyond the table, tables beyond the bytes, no bytes at all.
TEST(DepthCodec, AnyBytesEndWithinTheirBounds) {
    shared::RandomValues chance(3);
    std::vector<std::uint16_t> read(300);
    for (int i = 0; i < 20'000; ++i) {
        std::vector<std::byte> bytes(static_cast<std::size_t>(chance.below(200)));
        std::ranges::generate(bytes, [&] { return static_cast<std::byte>(chance.below(256)); });
        for (const DepthCodec codec : all_codecs) {
            EXPECT_LE(decode_depth(codec, bytes, read), read.size());
        }
    }
    const std::array<std::byte, 4> table{std::byte{0xff}, std::byte{0xff}, std::byte{1}, std::byte{0}};
    EXPECT_EQ(decode_depth(DepthCodec::indices, table, read), 0u);
    EXPECT_EQ(decode_depth(DepthCodec::indices, {}, read), 0u);
}

TEST(DepthCodec, NoImageTakesMoreBytesThanIsSaid) {
    shared::RandomValues chance(4);
    std::vector<std::uint16_t> pixels(4000);
    std::ranges::generate(pixels, [&] { return static_cast<std::uint16_t>(chance.below(0x8000)); });
    for (const DepthCodec codec : all_codecs) {
        EXPECT_LE(shared::encode_depth(codec, pixels).size(), most_encoded_bytes(pixels.size()));
    }
}

}  // namespace
}  // namespace tactus::depth_codec_test
