#include "devices/steering.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

namespace tactus::steering_test {
namespace {

TEST(Steering, AStickAtRestIsNoDeflection) {
    EXPECT_EQ(effective_deflection({0.05, -0.08, 0.0}, 0.1), Vec3(0.0));
    EXPECT_EQ(effective_deflection(Vec3(0.0), 0.0), Vec3(0.0));
}

TEST(Steering, WhatIsNoNumberIsNoDeflection) {
    EXPECT_EQ(effective_deflection(Vec3(std::numeric_limits<double>::quiet_NaN()), 0.1), Vec3(0.0));
}

TEST(Steering, BeyondTheDeadZoneItBeginsAtNothingAndEndsAtOne) {
    EXPECT_LE(glm::length(effective_deflection({0.1001, 0.0, 0.0}, 0.1)), 2e-4);
    EXPECT_NEAR(effective_deflection({0.55, 0.0, 0.0}, 0.1).x, 0.5, 1e-12);
    EXPECT_NEAR(effective_deflection({0.0, -1.0, 0.0}, 0.1).y, -1.0, 1e-12);
}

TEST(Steering, TwoFullAxesAreNotFasterThanOne) {
    EXPECT_NEAR(glm::length(effective_deflection({1.0, 1.0, -1.0}, 0.1)), 1.0, 1e-12);
}

TEST(Steering, ARateIsTheSameWayInAnySteps) {
    const SteeringSettings settings{.speed = 0.1, .dead_zone = 0.0};
    Vec3 place(0.0);
    for (int i = 0; i < 60; ++i) {
        place = steered(place, {0.5, 0.0, 0.0}, settings, 1.0 / 60.0);
    }
    EXPECT_NEAR(place.x, 0.05, 1e-12);
    EXPECT_NEAR(steered(Vec3(0.0), {0.5, 0.0, 0.0}, settings, 1.0).x, place.x, 1e-12);
    EXPECT_EQ(steered(place, Vec3(0.0), settings, 1.0), place) << "let go, it stays";
}

TEST(Steering, APositionIsBackOnceItIsLetGo) {
    const SteeringSettings settings{.mode = SteeringMode::position, .reach = 0.2, .dead_zone = 0.0};
    const Vec3 away = steered(Vec3(0.0), {0.0, 0.0, 1.0}, settings, 0.016);
    EXPECT_NEAR(away.z, 0.2, 1e-12);
    EXPECT_EQ(steered(away, Vec3(0.0), settings, 0.016), Vec3(0.0));
}

TEST(Steering, NoDeflectionLeadsOutOfReach) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-2.0, 2.0);
    for (const SteeringMode mode : {SteeringMode::rate, SteeringMode::position}) {
        const SteeringSettings settings{.mode = mode, .reach = 0.2, .speed = 5.0};
        Vec3 place(0.0);
        for (int i = 0; i < 1000; ++i) {
            place = steered(place, {any(random), any(random), any(random)}, settings, 0.02);
            ASSERT_LE(glm::length(place), 0.2 * (1.0 + 1e-12));
        }
    }
}

}  // namespace
}  // namespace tactus::steering_test
