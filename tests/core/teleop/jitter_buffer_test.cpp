#include "core/teleop/jitter_buffer.hpp"

#include <gtest/gtest.h>

namespace tactus {
namespace {

struct Sample {
    std::uint64_t sequence = 0;
    Vec3 position{0.0};
    Vec3 velocity{0.0};
};

Sample sample(std::uint64_t sequence) {
    return {sequence, {0.001 * static_cast<double>(sequence), 0.0, 0.0}, {1.0, 0.0, 0.0}};
}

using Buffer = JitterBuffer<Sample>;

TEST(JitterBuffer, WaitsUntilSomethingComes) {
    Buffer buffer;
    Sample out;
    EXPECT_EQ(buffer.play(out), Playing::waiting);
}

TEST(JitterBuffer, PlaysInOrderWhatComesOutOfOrder) {
    JitterBufferSettings settings;
    settings.depth = 2;
    Buffer buffer(settings);
    for (const std::uint64_t sequence : {2u, 1u, 3u}) {
        buffer.insert(sample(sequence));
    }
    for (std::uint64_t sequence = 1; sequence <= 3; ++sequence) {
        Sample out;
        ASSERT_EQ(buffer.play(out), Playing::exact);
        EXPECT_EQ(out.sequence, sequence);
    }
}

TEST(JitterBuffer, KeepsItsDepthAtTheStart) {
    JitterBufferSettings settings;
    settings.depth = 3;
    Buffer buffer(settings);
    Sample out;
    for (std::uint64_t sequence = 1; sequence <= 3; ++sequence) {
        buffer.insert(sample(sequence));
        EXPECT_EQ(buffer.play(out), Playing::waiting);
    }
    buffer.insert(sample(4));
    EXPECT_EQ(buffer.play(out), Playing::exact);
    EXPECT_EQ(out.sequence, 1u);
}

TEST(JitterBuffer, FillsALossBetweenItsNeighbours) {
    Buffer buffer;
    Sample out;
    buffer.insert(sample(1));
    buffer.play(out);
    buffer.insert(sample(4));
    ASSERT_EQ(buffer.play(out), Playing::filled);
    EXPECT_EQ(out.sequence, 2u);
    EXPECT_NEAR(out.position.x, 0.002, 1e-15);
    ASSERT_EQ(buffer.play(out), Playing::filled);
    EXPECT_NEAR(out.position.x, 0.003, 1e-15);
    EXPECT_EQ(buffer.play(out), Playing::exact);
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

TEST(JitterBuffer, BecomesLessDeepWhereThatIsNotNeeded) {
    JitterBufferSettings settings;
    settings.patience = 100;
    Buffer buffer(settings);
    Sample out;
    for (std::uint64_t sequence = 1; sequence <= 5; ++sequence) {
        buffer.insert(sample(sequence));
    }
    for (std::uint64_t sequence = 6; sequence < 2000; ++sequence) {
        buffer.insert(sample(sequence));
        buffer.play(out);
    }
    EXPECT_LE(buffer.depth(), 2u);
    EXPECT_GE(buffer.counts().left_out, 3u);
}

TEST(JitterBuffer, CountsWhatComesTwiceOrLate) {
    Buffer buffer;
    Sample out;
    buffer.insert(sample(1));
    buffer.insert(sample(1));
    buffer.play(out);
    buffer.insert(sample(1));
    EXPECT_EQ(buffer.counts().doubled, 1u);
    EXPECT_EQ(buffer.counts().late, 1u);
}

TEST(JitterBuffer, SparseGoesOnWithTheLastVelocity) {
    JitterBufferSettings settings;
    settings.sparse = true;
    Buffer buffer(settings);
    Sample out;
    buffer.insert(sample(1));
    buffer.play(out);
    for (std::uint64_t sequence = 2; sequence <= 20; ++sequence) {
        ASSERT_EQ(buffer.play(out), Playing::guessed);
        EXPECT_EQ(out.sequence, sequence);
        EXPECT_NEAR(out.position.x, 0.001 * static_cast<double>(sequence), 1e-12);
    }
}

TEST(JitterBuffer, SparseGuessesFromWhatComesTooLate) {
    JitterBufferSettings settings;
    settings.sparse = true;
    Buffer buffer(settings);
    Sample out;
    buffer.insert(sample(1));
    for (int i = 0; i < 4; ++i) {
        buffer.play(out);
    }
    Sample turned = sample(3);
    turned.velocity = {0.0, 1.0, 0.0};
    buffer.insert(turned);
    ASSERT_EQ(buffer.play(out), Playing::guessed);
    EXPECT_NEAR(out.position.x, 0.003, 1e-12);
    EXPECT_NEAR(out.position.y, 0.002, 1e-12);
}

// The first packet may have been the slowest one, or hold samples of long ago.
TEST(JitterBuffer, SparseFollowsTheFastestPacket) {
    JitterBufferSettings settings;
    settings.sparse = true;
    Buffer buffer(settings);
    Sample out;
    for (const std::uint64_t sequence : {1, 20, 50}) {
        buffer.insert(sample(sequence));
    }
    buffer.play(out);
    ASSERT_EQ(buffer.play(out), Playing::exact);
    EXPECT_EQ(out.sequence, 50u);
    ASSERT_EQ(buffer.play(out), Playing::guessed);
    EXPECT_NEAR(out.position.x, 0.051, 1e-12);
}

TEST(JitterBuffer, AJumpTooWideToFillIsANewBeginning) {
    Buffer buffer;
    Sample out;
    buffer.insert(sample(1));
    buffer.play(out);
    buffer.insert(sample(1'000'000));
    ASSERT_EQ(buffer.play(out), Playing::exact);
    EXPECT_EQ(out.sequence, 1'000'000u);
    EXPECT_EQ(buffer.counts().restarts, 1u);
}

}  // namespace
}  // namespace tactus
