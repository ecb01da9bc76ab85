#include "realtime/awake_processor.hpp"

#include <gtest/gtest.h>

namespace tactus::awake_processor_test {
namespace {

TEST(AwakeProcessor, NeedsOneProcessor) {
    AwakeProcessor awake;
    EXPECT_NE(awake.start(-1, {}), "");
    EXPECT_NE(awake.start(1 << 20, {}), "");
}

TEST(AwakeProcessor, StartsAndStopsAgainAndAgain) {
    AwakeProcessor awake;
    for (int round = 0; round < 3; ++round) {
        awake.start(0, {});
        awake.stop();
        awake.stop();
    }
    SUCCEED();
}

}  // namespace
}  // namespace tactus::awake_processor_test
