#include "core/safety/force_exit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tactus::force_exit_test {
namespace {

constexpr double tick = 0.001;
constexpr double most = 10.0;

TEST(ForceExit, AnOrdinaryForceLeavesAsItIs) {
    ForceExit exit;
    bool limited = false;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 force(0.0, 3.0 * std::abs(std::sin(0.005 * i)), 0.1);
        EXPECT_EQ(exit.leave({}, force, most, {0.0, -0.1, 0.0}, tick, 0.0, limited), force);
    }
    EXPECT_FALSE(limited);
}

TEST(ForceExit, AForceOfAnySizeGrowsNoFasterThanAllowedAndNoLarger) {
    for (const double size : {1e3, 1e9, 1e100}) {
        ForceExit exit;
        const ForceLimits limits;
        bool limited = false;
        Vec3 before(0.0);
        for (int i = 0; i < 100; ++i) {
            const Vec3 force = exit.leave(limits, {0.0, size, 0.0}, most, Vec3(0.0), tick, 0.0, limited);
            EXPECT_LE(glm::distance(force, before), limits.slew * tick * 1.000001);
            EXPECT_LE(glm::length(force), most * 1.000001);
            before = force;
        }
        EXPECT_TRUE(limited);
        EXPECT_NEAR(before.y, most, 1e-9);
    }
}

// A hand that slips off an edge of what has not been corrected.
TEST(ForceExit, WhatTheHandItselfHasDoneIsNotHeldBack) {
    ForceExit exit;
    const ForceLimits limits;
    bool limited = false;
    const Vec3 pressed(0.0, 1.0, 0.0), slipped(8.0, 0.0, 0.0);
    exit.leave(limits, pressed, most, Vec3(0.0), tick, 0.0, limited);
    EXPECT_EQ(exit.leave(limits, slipped, most, Vec3(0.0), tick, glm::distance(pressed, slipped), limited),
              slipped);
    EXPECT_FALSE(limited);
    EXPECT_NE(exit.leave(limits, pressed, most, Vec3(0.0), tick, 1.0, limited), pressed);
    EXPECT_TRUE(limited);
}

TEST(ForceExit, WhatIsNoNumberIsNoForce) {
    ForceExit exit;
    bool limited = false;
    for (const double wild : {std::nan(""), HUGE_VAL}) {
        const Vec3 force = exit.leave({}, {wild, 0.0, 0.0}, most, {0.1, 0.0, 0.0}, tick, 0.0, limited);
        EXPECT_TRUE(std::isfinite(force.x));
    }
}

TEST(ForceExit, NoMoreEnergyThanAllowedIsGivenToAHandThatRunsAway) {
    ForceExit exit;
    const ForceLimits limits;
    bool limited = false;
    double energy = 0.0;
    for (int i = 1; i <= 3000; ++i) {
        const Vec3 velocity(0.0, 2.0, 0.0);
        const Vec3 force = exit.leave(limits, {0.0, 9.0, 0.0}, most, velocity, tick, 0.0, limited);
        energy += glm::dot(force, velocity) * tick;
        ASSERT_LE(energy, limits.energy + limits.power * i * tick + 1e-9);
    }
    EXPECT_TRUE(limited);
    EXPECT_GT(energy, limits.power * 2.9);
}

}  // namespace
}  // namespace tactus::force_exit_test
