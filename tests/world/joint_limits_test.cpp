#include "world/joint_limits.hpp"

#include <gtest/gtest.h>

namespace tactus::joint_limits_test {
namespace {

void expect_same(const JointRange& range, double lower, double upper) {
    EXPECT_EQ(range.lower, lower);
    EXPECT_EQ(range.upper, upper);
}

TEST(JointLimits, LimitsThatAreNotUsedLeaveItFree) {
    expect_same(limits(true, -0.3, 0.5), -0.3, 0.5);
    const JointRange unused = limits(false, -0.3, 0.5);
    EXPECT_GT(unused.lower, unused.upper);
}

TEST(JointLimits, AnglesAreSeenFromTheOtherBody) {
    expect_same(turned({-0.3, 0.5}), -0.5, 0.3);
    expect_same(turned(turned({-0.3, 0.5})), -0.3, 0.5);
    const JointRange free = turned({2.0, 1.0});
    EXPECT_GT(free.lower, free.upper) << "lower above upper is free, seen from either";
}

}  // namespace
}  // namespace tactus::joint_limits_test
