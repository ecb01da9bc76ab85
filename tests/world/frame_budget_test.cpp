#include "world/frame_budget.hpp"

#include <gtest/gtest.h>

namespace tactus::frame_budget_test {
namespace {

constexpr double budget = 1e-3;

TEST(FrameBudget, NowAndThenAFrameMayTakeLonger) {
    FrameBudget frames;
    for (int i = 0; i < 100; ++i) {
        EXPECT_FALSE(frames.is_overdrawn(i % 5 == 0 ? budget : 2.0 * budget, budget)) << i;
    }
}

TEST(FrameBudget, FiveInARowAreTooMany) {
    FrameBudget frames;
    for (int i = 0; i < 4; ++i) {
        EXPECT_FALSE(frames.is_overdrawn(2.0 * budget, budget)) << i;
    }
    EXPECT_TRUE(frames.is_overdrawn(2.0 * budget, budget));
}

TEST(FrameBudget, ForgottenTheyAreCountedAnew) {
    FrameBudget frames;
    for (int i = 0; i < 4; ++i) {
        frames.is_overdrawn(2.0 * budget, budget);
    }
    frames.forget();
    EXPECT_FALSE(frames.is_overdrawn(2.0 * budget, budget));
}

TEST(FrameBudget, OneThatIsFarTooLateIsTooMany) {
    EXPECT_FALSE(FrameBudget().is_overdrawn(100.0 * budget, budget));
    EXPECT_TRUE(FrameBudget().is_overdrawn(100.1 * budget, budget));
}

}  // namespace
}  // namespace tactus::frame_budget_test
