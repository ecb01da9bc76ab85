// The force of a button over its travel.
#include "core/haptics/force_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus::force_curve_test {
namespace {

TEST(ForceCurve, IsStraightBetweenSamplesAndGoesOnAsStiffAsTheSurface) {
    const auto curve = ForceCurve::of(0.004, {0.0, 2.0, 1.0, 3.0, 3.0});
    EXPECT_EQ(check_curve(*curve), "");
    EXPECT_NEAR(curve->at(0.0005, 500.0).force, 1.0, 1e-12);
    EXPECT_NEAR(curve->at(0.001, 500.0).force, 2.0, 1e-12);
    EXPECT_NEAR(curve->at(0.0015, 500.0).force, 1.5, 1e-12);
    EXPECT_NEAR(curve->at(0.0015, 500.0).slope, -1000.0, 1e-9);
    EXPECT_NEAR(curve->at(0.005, 500.0).force, 3.5, 1e-12);
    EXPECT_EQ(curve->at(0.005, 500.0).slope, 500.0);
    EXPECT_EQ(curve->at(-1.0, 500.0).force, 0.0);
    EXPECT_NEAR(curve->steepest, 2000.0, 1e-9);
}

TEST(ForceCurve, WhatIsNoneIsSaid) {
    const double nan = std::nan("");
    for (const auto& [depth, forces] : {std::pair<double, std::vector<double>>{0.0, {0.0, 1.0}},
                                        {0.01, {0.0}},
                                        {0.01, {}},
                                        {0.01, {1.0, 1.0}},
                                        {0.01, {0.0, -1.0}},
                                        {0.01, {0.0, nan}},
                                        {nan, {0.0, 1.0}},
                                        {0.01, std::vector<double>(ForceCurve::most + 1, 0.0)}}) {
        EXPECT_NE(check_curve(*ForceCurve::of(depth, forces)), "");
    }
    ForceCurve lying = *ForceCurve::of(0.01, {0.0, 1.0});
    lying.steepest = 0.0;
    EXPECT_NE(check_curve(lying), "");
}

}  // namespace
}  // namespace tactus::force_curve_test
