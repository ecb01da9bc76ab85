#include "realtime/recorder_ring.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/realtime_audit.hpp"

namespace tactus::recorder_ring_test {
namespace {

struct Row {
    std::int64_t time_us = 0;
    double force_y = 0.0;
};

std::vector<Row> drained(RecorderRing<Row>& ring) {
    std::vector<Row> rows;
    ring.drain([&](const Row& row) { rows.push_back(row); });
    return rows;
}

TEST(RecorderRing, DrainsInTheOrderOfAppending) {
    RecorderRing<Row> ring(8);
    ring.append({1, 0.5});
    ring.append({2, 0.25});
    const std::vector<Row> rows = drained(ring);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].time_us, 1);
    EXPECT_EQ(rows[1].force_y, 0.25);
    EXPECT_TRUE(drained(ring).empty());
}

TEST(RecorderRing, WhatFindsNoRoomIsCountedOnce) {
    RecorderRing<Row> ring(4);
    for (int i = 0; i < 7; ++i) {
        EXPECT_EQ(ring.append({i, 0.0}), i < 4);
    }
    EXPECT_EQ(ring.take_lost(), 3u);
    EXPECT_EQ(ring.take_lost(), 0u);
}

TEST(RecorderRing, KeepsTheOldestWhenFull) {
    RecorderRing<Row> ring(2);
    for (int i = 0; i < 5; ++i) {
        ring.append({i, 0.0});
    }
    const std::vector<Row> rows = drained(ring);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].time_us, 0);
    EXPECT_EQ(rows[1].time_us, 1);
}

TEST(RecorderRing, OneDrainEndsEvenIfRecordsKeepComing) {
    RecorderRing<Row> ring(4);
    ring.append({0, 0.0});
    const std::size_t taken = ring.drain([&](const Row&) { ring.append({1, 0.0}); });
    EXPECT_EQ(taken, 4u);
}

TEST(RecorderRing, AppendingNeitherAllocatesNorLocks) {
    RecorderRing<Row> ring(4);
    testing::AuditScope audit;
    for (int i = 0; i < 10; ++i) {
        ring.append({i, 0.0});
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.locks() + audit.system_calls(), 0u) << audit.describe();
}

}  // namespace
}  // namespace tactus::recorder_ring_test
