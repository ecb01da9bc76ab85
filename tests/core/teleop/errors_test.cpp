#include "core/teleop/errors.hpp"

#include <gtest/gtest.h>

namespace tactus {
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

}  // namespace
}  // namespace tactus
