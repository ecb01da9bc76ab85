#include "platform/beside_loop.hpp"

#include <gtest/gtest.h>

namespace tactus::beside_loop_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;

TEST(CrowdedOut, KeepsOffWhileItWorksMoreThanItWaits) {
    CrowdedOut crowded;
    for (int i = 0; i < 1000; ++i) {
        EXPECT_TRUE(crowded.keeps_off());
        crowded.burst(6 * ms, 10 * ms);
    }
}

TEST(CrowdedOut, OneLongWaitAmongOthersIsNoReasonToComeBack) {
    CrowdedOut crowded;
    for (int i = 0; i < 1000; ++i) {
        crowded.burst(9 * ms, i % 10 == 0 ? 80 * ms : 10 * ms);
        EXPECT_TRUE(crowded.keeps_off());
    }
}

TEST(CrowdedOut, ComesBackWhereItMostlyWaitsAndTriesAgainLater) {
    CrowdedOut crowded;
    int off = 0;
    for (int i = 0; i < 3100; ++i) {
        off += crowded.keeps_off() ? 1 : 0;
        crowded.burst(2 * ms, 10 * ms);
    }
    EXPECT_EQ(off, 100);  // ten bursts of each 310
}

}  // namespace
}  // namespace tactus::beside_loop_test
