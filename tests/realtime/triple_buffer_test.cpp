#include "realtime/triple_buffer.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "support/realtime_audit.hpp"

namespace tactus::triple_buffer_test {
namespace {

TEST(TripleBuffer, StartsWithTheInitialValueEverywhere) {
    TripleBuffer<std::vector<int>> buffer(std::vector<int>(3, 5));
    EXPECT_FALSE(buffer.refresh());
    EXPECT_EQ(buffer.front(), std::vector<int>(3, 5));
    EXPECT_EQ(buffer.back(), std::vector<int>(3, 5));
}

TEST(TripleBuffer, TheReaderSeesNothingBeforePublishing) {
    TripleBuffer<int> buffer(1);
    buffer.back() = 2;
    EXPECT_FALSE(buffer.refresh());
    EXPECT_EQ(buffer.front(), 1);
}

TEST(TripleBuffer, TheNewestWins) {
    TripleBuffer<int> buffer;
    for (int i = 1; i <= 10; ++i) {
        buffer.publish(i);
    }
    EXPECT_TRUE(buffer.refresh());
    EXPECT_EQ(buffer.front(), 10);
}

TEST(TripleBuffer, OneValueIsTakenOnce) {
    TripleBuffer<int> buffer;
    buffer.publish(1);
    EXPECT_TRUE(buffer.refresh());
    EXPECT_FALSE(buffer.refresh());
    EXPECT_EQ(buffer.front(), 1);
}

TEST(TripleBuffer, TheFrontStandsStillWhileTheWriterGoesOn) {
    TripleBuffer<int> buffer;
    buffer.publish(1);
    buffer.refresh();
    const int& front = buffer.front();
    for (int i = 2; i < 20; ++i) {
        buffer.publish(i);
        EXPECT_EQ(front, 1);
    }
}

TEST(TripleBuffer, NoHalfWrittenAndNoOlderValueBetweenTwoThreads) {
    struct Pair {
        std::uint64_t counter = 0;
        std::uint64_t filler[30] = {};
        std::uint64_t same = 0;
    };
    constexpr std::uint64_t last = 200'000;
    TripleBuffer<Pair> buffer;
    std::thread writer([&] {
        for (std::uint64_t i = 1; i <= last; ++i) {
            Pair& back = buffer.back();
            back.counter = i;
            back.same = i;
            buffer.publish();
        }
    });
    std::uint64_t seen = 0;
    bool whole = true;
    bool forward = true;
    while (seen < last) {
        if (!buffer.refresh()) {
            std::this_thread::yield();
            continue;
        }
        whole = whole && buffer.front().counter == buffer.front().same;
        forward = forward && buffer.front().counter > seen;
        seen = buffer.front().counter;
    }
    writer.join();
    EXPECT_TRUE(whole);
    EXPECT_TRUE(forward);
}

TEST(TripleBuffer, NeitherAllocatesNorLocks) {
    TripleBuffer<int> buffer;
    testing::AuditScope audit;
    for (int i = 0; i < 10; ++i) {
        buffer.publish(i);
        buffer.refresh();
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.locks() + audit.system_calls(), 0u) << audit.describe();
}

}  // namespace
}  // namespace tactus::triple_buffer_test
