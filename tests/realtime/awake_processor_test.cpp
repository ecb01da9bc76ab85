#include "realtime/awake_processor.hpp"

#include <gtest/gtest.h>
#include <sched.h>

namespace tactus {
namespace {

TEST(LimitsProcessorTime, ReadsTheControlGroupsAllowance) {
    EXPECT_TRUE(limits_processor_time("200000 100000"));
    EXPECT_FALSE(limits_processor_time("max 100000"));
    EXPECT_FALSE(limits_processor_time(""));
}

TEST(AwakeProcessor, NeedsOneProcessor) {
    AwakeProcessor awake;
    EXPECT_NE(awake.start(-1), "");
    EXPECT_NE(awake.start(1 << 20), "");
}

TEST(AwakeProcessor, StartsAndStopsAgainAndAgain) {
    AwakeProcessor awake;
    for (int round = 0; round < 3; ++round) {
        awake.start(sched_getcpu());
        awake.stop();
        awake.stop();
    }
    SUCCEED();
}

}  // namespace
}  // namespace tactus
