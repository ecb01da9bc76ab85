#include "realtime/spsc_ring.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>

#include "support/realtime_audit.hpp"

namespace tactus::spsc_ring_test {
namespace {

TEST(SpscRing, GivesBackInTheOrderOfPushing) {
    SpscRing<int> ring(4);
    EXPECT_TRUE(ring.try_push(1));
    EXPECT_TRUE(ring.try_push(2));
    int value = 0;
    EXPECT_TRUE(ring.try_pop(value));
    EXPECT_EQ(value, 1);
    EXPECT_TRUE(ring.try_pop(value));
    EXPECT_EQ(value, 2);
}

TEST(SpscRing, EmptyGivesNothing) {
    SpscRing<int> ring(4);
    int value = 7;
    EXPECT_FALSE(ring.try_pop(value));
    EXPECT_EQ(value, 7);
    EXPECT_EQ(ring.front(), nullptr);
}

TEST(SpscRing, HoldsAtLeastWhatWasAskedFor) {
    EXPECT_EQ(SpscRing<int>(5).capacity(), 8u);
    EXPECT_EQ(SpscRing<int>(8).capacity(), 8u);
    EXPECT_EQ(SpscRing<int>(0).capacity(), 1u);
}

TEST(SpscRing, FullRefusesAndLeavesTheValueAlone) {
    SpscRing<std::unique_ptr<int>> ring(1);
    EXPECT_TRUE(ring.try_push(std::make_unique<int>(1)));
    auto second = std::make_unique<int>(2);
    EXPECT_FALSE(ring.try_push(std::move(second)));
    ASSERT_NE(second, nullptr);
    EXPECT_EQ(*second, 2);
}

TEST(SpscRing, RoomComesBackAfterPopping) {
    SpscRing<int> ring(2);
    int value = 0;
    for (int i = 0; i < 1000; ++i) {
        ASSERT_TRUE(ring.try_push(i));
        ASSERT_TRUE(ring.try_pop(value));
        ASSERT_EQ(value, i);
    }
    EXPECT_EQ(ring.size(), 0u);
}

TEST(SpscRing, FrontIsReadInPlaceAndStaysUntilPopped) {
    SpscRing<std::string> ring(2);
    ring.try_push(std::string("first"));
    ASSERT_NE(ring.front(), nullptr);
    EXPECT_EQ(*ring.front(), "first");
    EXPECT_EQ(ring.size(), 1u);
    ring.pop();
    EXPECT_EQ(ring.front(), nullptr);
}

TEST(SpscRing, DestroysWhatIsLeftInside) {
    const auto witness = std::make_shared<int>(0);
    {
        SpscRing<std::shared_ptr<int>> ring(4);
        ring.try_push(witness);
        ring.try_push(witness);
        EXPECT_EQ(witness.use_count(), 3);
    }
    EXPECT_EQ(witness.use_count(), 1);
}

TEST(SpscRing, CarriesEverythingBetweenTwoThreadsInOrder) {
    constexpr std::uint64_t count = 200'000;
    SpscRing<std::uint64_t> ring(64);
    std::thread producer([&] {
        for (std::uint64_t i = 0; i < count;) {
            if (ring.try_push(i)) {
                ++i;
            } else {
                std::this_thread::yield();
            }
        }
    });
    std::uint64_t expected = 0;
    bool in_order = true;
    while (expected < count) {
        std::uint64_t value = 0;
        if (ring.try_pop(value)) {
            in_order = in_order && value == expected;
            ++expected;
        } else {
            std::this_thread::yield();
        }
    }
    producer.join();
    EXPECT_TRUE(in_order);
}

TEST(SpscRing, NeitherAllocatesNorLocks) {
    SpscRing<std::uint64_t> ring(8);
    std::uint64_t value = 0;
    testing::AuditScope audit;
    for (std::uint64_t i = 0; i < 20; ++i) {
        ring.try_push(i);
        if (i % 3 == 0) {
            ring.try_pop(value);
        }
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees() + audit.locks() + audit.system_calls(), 0u)
        << audit.describe();
}

}  // namespace
}  // namespace tactus::spsc_ring_test
