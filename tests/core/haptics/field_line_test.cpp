// What of a force along a line is safe to render, and that it does the work of the force itself.
#include "core/haptics/field_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace tactus::field_line_test {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();
constexpr double near = 0.004;

// Evenly sampled along x, from 24 mm on one side of the origin to 24 mm on the other.
FieldProfile profile_of(const std::function<double(double)>& force) {
    FieldLine line;
    line.direction = {1.0, 0.0, 0.0};
    line.near = near;
    for (int i = 0; i < FieldLine::most; ++i) {
        const double at = 0.048 * i / (FieldLine::most - 1) - 0.024;
        line.add(at, {force(at), 0.0, 0.0});
    }
    return {Vec3(0.0), line};
}

// Of what is rendered where the hand may get (unit: newtons per meter).
double steepest(const FieldProfile& profile) {
    double largest = 0.0;
    constexpr double step = 1e-5;
    for (double s = -near; s < near; s += step) {
        largest = std::max(largest, std::abs(profile.rendered(s + step).x - profile.rendered(s).x) / step);
    }
    return largest;
}

double leap(double x) {
    return x <= 0.0 ? 5.0 : 0.0;
}

TEST(FieldLine, SamplesStandInOrderHoweverTheyCome) {
    FieldLine line;
    for (const double at : {0.0, 3.0, -2.0, 1.0, -5.0}) {
        line.add(at, {at, 0.0, 0.0});
    }
    ASSERT_EQ(line.count, 5);
    const double sorted[] = {-5.0, -2.0, 0.0, 1.0, 3.0};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(line.at[i], sorted[i]);
        EXPECT_EQ(line.force[i].x, sorted[i]);
    }
}

TEST(FieldProfile, WhatIsNoSteeperThanIsSafeIsRenderedAsItIs) {
    FieldProfile profile = profile_of([](double x) { return 2.0 - 500.0 * x; });
    profile.make_safe(800.0, no_limit, {});
    EXPECT_FALSE(profile.is_weaker());
    EXPECT_NEAR(profile.steepest(), 500.0, 1e-9);
    for (const double s : {-0.02, -0.001, 0.0, 0.003}) {
        EXPECT_NEAR(profile.rendered(s).x, 2.0 - 500.0 * s, 1e-12);
    }
}

TEST(FieldProfile, BeyondItsSamplesItIsConstant) {
    const FieldProfile profile = profile_of([](double x) { return -100.0 * x; });
    EXPECT_NEAR(profile.force(-1.0).x, 2.4, 1e-12);
    EXPECT_NEAR(profile.force(1.0).x, -2.4, 1e-12);
    EXPECT_NEAR(profile.integral(1.0).x - profile.integral(0.024).x, -2.4 * 0.976, 1e-12);
    EXPECT_NEAR(profile.integral(-0.024).x - profile.integral(-1.0).x, 2.4 * 0.976, 1e-12);
}

TEST(FieldProfile, ALeapRisesAsSteeplyAsIsSafe) {
    for (const double safe : {400.0, 800.0, 2000.0}) {
        FieldProfile profile = profile_of(leap);
        profile.make_safe(safe, no_limit, {});
        EXPECT_TRUE(profile.is_weaker());
        EXPECT_LE(steepest(profile), safe * 1.001) << safe;
        EXPECT_GE(steepest(profile), safe / 1.3) << safe << ": and no less";
    }
}

TEST(FieldProfile, ItDoesTheWorkOfTheForceItself) {
    FieldProfile profile = profile_of(leap);
    profile.make_safe(2000.0, no_limit, {});
    double rendered = 0.0;
    constexpr double step = 1e-6;
    for (double s = -0.01; s < 0.01; s += step) {
        rendered += profile.rendered(s + 0.5 * step).x * step;
    }
    EXPECT_NEAR(rendered, profile.integral(0.01).x - profile.integral(-0.01).x, 1e-7);
}

TEST(FieldProfile, ASpringThatIsTooSteepIsASofterOne) {
    for (const double stiffness : {3000.0, 10'000.0}) {
        FieldProfile profile = profile_of([&](double x) { return -stiffness * x; });
        profile.make_safe(1500.0, 8.0, {});
        EXPECT_LE(steepest(profile), 1500.0 * 1.001) << stiffness;
        EXPECT_NEAR(profile.rendered(0.0).x, 0.0, 1e-9) << stiffness;
        EXPECT_LT(profile.rendered(2e-3).x, -1.5) << stiffness;
    }
}

TEST(FieldProfile, AWindowThatFitsIsKept) {
    const auto force = [](double x) { return 3.0 * std::sin(2.0 * std::numbers::pi * x / 0.006); };
    FieldProfile before = profile_of(force);
    before.make_safe(1000.0, no_limit, {});
    FieldProfile after = profile_of([&](double x) { return 1.05 * force(x + 1e-4); });
    after.make_safe(1000.0, no_limit, before);
    FieldProfile alone = profile_of([&](double x) { return force(x); });
    alone.make_safe(1000.0, no_limit, before);
    EXPECT_EQ(alone.rendered(1e-3), before.rendered(1e-3)) << "nothing has changed";
    EXPECT_LE(steepest(after), 1000.0 * 1.001);
}

TEST(FieldProfile, WithoutALineThereIsOneForceEverywhere) {
    FieldProfile profile(Vec3(1.0), Vec3(0.0, 2.0, 0.0));
    profile.make_safe(1.0, no_limit, {});
    EXPECT_EQ(profile.rendered(5.0), Vec3(0.0, 2.0, 0.0));
    EXPECT_EQ(profile.across({2.0, 1.0, 1.0}), Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(profile.steepest(), 0.0);
    EXPECT_EQ(FieldProfile().rendered(0.0), Vec3(0.0));
}

}  // namespace
}  // namespace tactus::field_line_test
