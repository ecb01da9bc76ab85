#include "core/teleop/deadband.hpp"

#include <gtest/gtest.h>

namespace tactus {
namespace {

TEST(Deadband, WithoutItEverythingIsSent) {
    EXPECT_TRUE(position_needs_sending({}, Vec3(0.0), Vec3(0.0), Vec3(0.0)));
    EXPECT_TRUE(force_needs_sending({}, Vec3(0.0), Vec3(0.0)));
}

TEST(Deadband, AGoodGuessNeedsNothing) {
    DeadbandSettings settings;
    settings.enabled = true;
    const Vec3 guessed = guessed_position({0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, 0.01);
    EXPECT_FALSE(position_needs_sending(settings, guessed, {0.001, 0.0, 0.0}, {0.1, 0.0, 0.0}));
    EXPECT_TRUE(position_needs_sending(settings, guessed, {0.0013, 0.0, 0.0}, {0.1, 0.0, 0.0}));
}

TEST(Deadband, WebersShareGrowsWithTheForce) {
    DeadbandSettings settings;
    settings.enabled = true;
    EXPECT_FALSE(force_needs_sending(settings, {0.0, 2.0, 0.0}, {0.0, 2.1, 0.0}));
    EXPECT_TRUE(force_needs_sending(settings, {0.0, 0.2, 0.0}, {0.0, 0.3, 0.0}));
}

}  // namespace
}  // namespace tactus
