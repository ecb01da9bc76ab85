#include "core/teleop/state_history.hpp"

#include <gtest/gtest.h>

namespace tactus::state_history_test {
namespace {

BodyMotion at(double x, double speed = 0.0) {
    BodyMotion motion;
    motion.pose.position = {x, 0.0, 0.0};
    motion.linear_velocity = {speed, 0.0, 0.0};
    return motion;
}

TEST(StateHistory, KnowsWhatWasSet) {
    StateHistory history(2, 4);
    history.set(1, 7, at(0.5));
    ASSERT_NE(history.at(1, 7), nullptr);
    EXPECT_EQ(history.at(1, 7)->pose.position.x, 0.5);
    EXPECT_EQ(history.at(0, 7), nullptr);
    EXPECT_EQ(history.at(5, 7), nullptr);
}

TEST(StateHistory, ForgetsTheOldest) {
    StateHistory history(1, 4);
    for (std::uint64_t sample = 1; sample <= 5; ++sample) {
        history.set(0, sample, at(static_cast<double>(sample)));
    }
    EXPECT_EQ(history.at(0, 1), nullptr);
    ASSERT_NE(history.at(0, 2), nullptr);
    EXPECT_EQ(history.at(0, 2)->pose.position.x, 2.0);
}

TEST(StateHistory, ACorrectionMovesThePastAsMuchAsThePresent) {
    StateHistory history(1, 8);
    for (std::uint64_t sample = 1; sample <= 4; ++sample) {
        history.set(0, sample, at(static_cast<double>(sample)));
    }
    history.carry(0, 2, 4, at(4.0), at(4.5, 0.25));
    EXPECT_EQ(history.at(0, 1)->pose.position.x, 1.0);
    EXPECT_EQ(history.at(0, 2)->pose.position.x, 2.5);
    EXPECT_EQ(history.at(0, 4)->pose.position.x, 4.5);
    EXPECT_EQ(history.at(0, 4)->linear_velocity.x, 0.25);
}

TEST(StateHistory, ForgetsABody) {
    StateHistory history(2, 4);
    history.set(0, 1, at(1.0));
    history.set(1, 1, at(2.0));
    history.forget(0);
    EXPECT_EQ(history.at(0, 1), nullptr);
    EXPECT_NE(history.at(1, 1), nullptr);
}

}  // namespace
}  // namespace tactus::state_history_test
