#include "core/teleop/deadband.hpp"

#include <gtest/gtest.h>

namespace tactus::deadband_test {
namespace {

TEST(Deadband, WithoutItEverythingIsSent) {
    EXPECT_TRUE(position_needs_sending({}, Vec3(0.0), Vec3(0.0), Vec3(0.0)));
    EXPECT_TRUE(force_needs_sending({}, Vec3(0.0), Vec3(0.0)));
}

TEST(Deadband, AGoodGuessNeedsNothing) {
    DeadbandSettings settings;
    settings.enabled = true;
    const Vec3 guessed = guessed_position({0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, 0.01);
    EXPECT_FALSE(position_needs_sending(settings, guessed, {0.00105, 0.0, 0.0}, {0.1, 0.0, 0.0}));
    EXPECT_TRUE(position_needs_sending(settings, guessed, {0.0013, 0.0, 0.0}, {0.1, 0.0, 0.0}));
}

TEST(Deadband, ABodyThatGoesOnAsWasSaidNeedsNothing) {
    DeadbandSettings settings;
    settings.enabled = true;
    BodyMotion guessed, actual;
    actual.pose.position.x = 0.5 * settings.position;
    EXPECT_FALSE(motion_needs_sending(settings, guessed, actual));
    actual.pose.position.x = 1.5 * settings.position;
    EXPECT_TRUE(motion_needs_sending(settings, guessed, actual));
    guessed = actual;
    actual.pose.rotation = glm::angleAxis(1.5 * settings.angle, Vec3(0.0, 1.0, 0.0));
    EXPECT_TRUE(motion_needs_sending(settings, guessed, actual));
    EXPECT_TRUE(motion_needs_sending({}, guessed, guessed));
}

TEST(Deadband, WebersShareGrowsWithTheForce) {
    DeadbandSettings settings;
    settings.enabled = true;
    EXPECT_FALSE(force_needs_sending(settings, {0.0, 2.0, 0.0}, {0.0, 2.1, 0.0}));
    EXPECT_TRUE(force_needs_sending(settings, {0.0, 0.2, 0.0}, {0.0, 0.3, 0.0}));
}

TEST(Deadband, AHandThatPressesMoreThanAGuessMayIsSent) {
    EXPECT_FALSE(press_needs_sending(2.0, 2.0 + 0.5 * guessed_force));
    EXPECT_TRUE(press_needs_sending(2.0, 2.01 + 0.5 * guessed_force));
    EXPECT_FALSE(press_needs_sending(2.0, 0.0)) << "a guess that presses less is no danger";
}

}  // namespace
}  // namespace tactus::deadband_test
