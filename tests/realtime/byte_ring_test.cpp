#include "realtime/byte_ring.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tactus::byte_ring_test {
namespace {

std::vector<std::byte> read(ByteRing& ring) {
    std::vector<std::byte> bytes;
    ring.read(bytes);
    return bytes;
}

TEST(ByteRing, WhatIsNotCommittedIsNotThere) {
    ByteRing ring(16);
    const std::byte three[] = {std::byte{1}, std::byte{2}, std::byte{3}};
    EXPECT_TRUE(ring.append(three, sizeof three));
    EXPECT_TRUE(read(ring).empty());
    ring.abandon();
    EXPECT_TRUE(ring.append(three, 2));
    ring.commit();
    EXPECT_EQ(read(ring).size(), 2u);
    EXPECT_TRUE(read(ring).empty());
}

TEST(ByteRing, WhatFindsNoRoomChangesNothing) {
    ByteRing ring(8);
    const std::uint64_t eight = 1;
    EXPECT_TRUE(ring.append(&eight, sizeof eight));
    EXPECT_FALSE(ring.append(&eight, 1));
    ring.commit();
    EXPECT_FALSE(ring.append(&eight, 1));
    EXPECT_EQ(read(ring).size(), 8u);
    EXPECT_TRUE(ring.append(&eight, sizeof eight));
}

TEST(ByteRing, BetweenTwoThreadsEveryGroupArrivesWholeAndInOrder) {
    constexpr std::uint32_t groups = 20'000;
    ByteRing ring(256);
    std::thread producer([&ring] {
        for (std::uint32_t i = 0; i < groups;) {
            bool fits = true;
            for (std::uint32_t copy = 0; copy <= i % 5; ++copy) {
                fits = fits && ring.append(&i, sizeof i);
            }
            if (fits) {
                ring.commit();
                ++i;
            } else {
                ring.abandon();
                std::this_thread::yield();
            }
        }
    });
    std::vector<std::byte> bytes;
    std::uint32_t next = 0;
    std::size_t at = 0;
    while (next < groups) {
        ring.read(bytes);
        while (at < bytes.size()) {
            for (std::uint32_t copy = 0; copy <= next % 5; ++copy, at += sizeof next) {
                ASSERT_LE(at + sizeof next, bytes.size()) << "half a group";
                ASSERT_EQ(std::memcmp(bytes.data() + at, &next, sizeof next), 0);
            }
            ++next;
        }
    }
    producer.join();
}

}  // namespace
}  // namespace tactus::byte_ring_test
