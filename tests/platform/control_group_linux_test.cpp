#include "platform/control_group_linux.hpp"

#include <gtest/gtest.h>

namespace tactus::control_group_linux_test {
namespace {

TEST(LimitsProcessorTime, ReadsTheControlGroupsAllowance) {
    EXPECT_TRUE(limits_processor_time("200000 100000"));
    EXPECT_FALSE(limits_processor_time("max 100000"));
    EXPECT_FALSE(limits_processor_time(""));
}

}  // namespace
}  // namespace tactus::control_group_linux_test
