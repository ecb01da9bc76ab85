#include "core/teleop/errors.hpp"

#include <gtest/gtest.h>

namespace tactus::errors_test {
namespace {

TEST(Errors, AForceInAWrongDirectionIsAnError) {
    EXPECT_DOUBLE_EQ(force_error({3.0, 0.0, 0.0}, {0.0, 4.0, 0.0}), 5.0);
}

TEST(Errors, PlacesAndTurnsAreApart) {
    const Pose a;
    const Pose b{{0.0, 0.003, 0.004}, glm::angleAxis(0.2, Vec3(0.0, 1.0, 0.0))};
    EXPECT_DOUBLE_EQ(position_error(a, b), 0.005);
    EXPECT_NEAR(rotation_error(a, b), 0.2, 1e-15);
}

TEST(Errors, ASeriesKnowsItsMeanItsRmsAndItsLargest) {
    Series series;
    EXPECT_EQ(series.mean(), 0.0);
    series.add(1.0);
    series.add(7.0);
    EXPECT_DOUBLE_EQ(series.mean(), 4.0);
    EXPECT_DOUBLE_EQ(series.rms(), 5.0);
    EXPECT_EQ(series.largest, 7.0);
}

TEST(FeltExcess, AConstantErrorHasNone) {
    const FeltExcess excess = felt_excess({3.0, 1.0, 0.0}, {2.0, 0.0, 0.0}, {1.5, 1.0, 0.0}, {0.5, 0.0, 0.0});
    EXPECT_EQ(excess.newtons, 0.0);
    EXPECT_EQ(excess.jnd, 0.0);
}

TEST(FeltExcess, IsComparedWithTheForceThatWasToBeExpected) {
    // 2 N was felt, direct touch has grown by 1 N: 3 N were to come, 4 N came.
    const FeltExcess excess = felt_excess({0.0, 4.0, 0.0}, {0.0, 2.0, 0.0}, {0.0, 2.0, 0.0}, {0.0, 1.0, 0.0});
    EXPECT_DOUBLE_EQ(excess.newtons, 1.0);
    EXPECT_DOUBLE_EQ(excess.jnd, 1.0 / just_noticeable({}, 3.0));
}

TEST(FeltExcess, AForceOutOfNothingCountsAgainstTheLeastNoticeable) {
    const FeltExcess excess = felt_excess({0.0, 0.1, 0.0}, Vec3(0.0), Vec3(0.0), Vec3(0.0));
    EXPECT_DOUBLE_EQ(excess.jnd, 0.1 / StealthSettings{}.least_noticeable);
}

TEST(PortEnergy, ASpringThatGivesBackWhatItTookHasCreatedNothing) {
    PortEnergy port;
    port.add({0.0, 2.0, 0.0}, {0.0, -0.01, 0.0});
    port.add({0.0, 2.0, 0.0}, {0.0, 0.01, 0.0});
    EXPECT_EQ(port.total(), 0.0);
    EXPECT_EQ(port.created(), 0.0);
}

TEST(PortEnergy, WhatOneContactTookIsNothingThatTheNextMayGive) {
    PortEnergy port;
    port.add({0.0, 2.0, 0.0}, {0.0, -0.01, 0.0});
    port.add(Vec3(0.0), {0.0, 0.05, 0.0});
    port.add({0.0, 1.0, 0.0}, {0.0, 0.01, 0.0});
    port.add({0.0, 1.0, 0.0}, {0.0, -0.01, 0.0});
    EXPECT_DOUBLE_EQ(port.created(), 0.01);
    EXPECT_DOUBLE_EQ(port.total(), -0.02);
}

}  // namespace
}  // namespace tactus::errors_test
