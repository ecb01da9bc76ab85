#include "core/tool/soft_finger.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "shared/slow_torsion.hpp"

namespace tactus::soft_finger_test {
namespace {

constexpr SoftFinger skin{1e5, 0.008};
constexpr Vec3 up{0.0, 1.0, 0.0};

TEST(SoftFinger, HoldsWhatCoulombsFrictionUnderHertzsPressureHolds) {
    for (const SoftFinger& finger : {skin, SoftFinger{1e9, 0.001}, SoftFinger{1e3, 1.0}}) {
        for (const double pressing : {0.01, 1.0, 30.0}) {
            const double right = shared::slow_torsion(finger, 0.7, pressing);
            EXPECT_NEAR(torsion_limit(finger, 0.7, pressing, 0.0), right, 1e-5 * right);
        }
    }
}

TEST(SoftFinger, WhatCarriesAForceHoldsLessTorque) {
    const double most = shared::slow_torsion(skin, 0.7, 8.0);
    for (const double share : {0.2, 0.4, 0.6, 0.8, 0.95}) {
        const double along = share * 0.7 * 8.0;
        const double right = shared::slow_torsion(skin, 0.7, 8.0, along);
        EXPECT_NEAR(torsion_limit(skin, 0.7, 8.0, along), right, 0.01 * most) << share;
    }
    EXPECT_EQ(torsion_limit(skin, 0.7, 8.0, 0.7 * 8.0), 0.0);
    EXPECT_EQ(torsion_limit(skin, 0.7, 8.0, 100.0), 0.0);
}

TEST(SoftFinger, APointASmoothSurfaceAndNoForceHoldNothing) {
    EXPECT_EQ(torsion_limit({}, 0.7, 8.0, 0.0), 0.0);
    EXPECT_EQ(torsion_limit(skin, 0.0, 8.0, 0.0), 0.0);
    EXPECT_EQ(torsion_limit(skin, 0.7, 0.0, 0.0), 0.0);
}

TEST(SoftFinger, SticksThenSlipsThenSticksAgain) {
    const TorsionLimits limits{0.03, 0.02};
    Torsion torsion;
    const auto torque = [&] { return torsion.stiffness * torsion.twist; };
    for (int i = 0; i < 19; ++i) {
        turn_in_grip(torsion, limits, 1e-4);
    }
    EXPECT_FALSE(torsion.slips);
    EXPECT_NEAR(torque(), 0.0285, 1e-9);
    for (int i = 0; i < 10; ++i) {
        turn_in_grip(torsion, limits, 1e-4);
    }
    EXPECT_TRUE(torsion.slips);
    EXPECT_NEAR(torque(), 0.02, 1e-12);
    EXPECT_EQ(torsion.limit, 0.02);
    turn_in_grip(torsion, limits, 0.0);
    EXPECT_FALSE(torsion.slips);
    EXPECT_EQ(torsion.limit, 0.03);
    turn_in_grip(torsion, limits, -1e-3);
    EXPECT_LT(torque(), 0.02);
}

// However the finger's force trembles: what the spring gives back never exceeds what was put in.
TEST(SoftFinger, MakesNoEnergy) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> chance(-1.0, 1.0);
    Torsion torsion;
    double put_in = 0.0;
    for (int i = 0; i < 20'000; ++i) {
        const double at_rest = 0.02 * (1.0 + chance(random));
        const double turned = 1e-3 * chance(random);
        turn_in_grip(torsion, {at_rest, 0.7 * at_rest}, turned);
        put_in += torsion.stiffness * torsion.twist * turned;
        EXPECT_GE(put_in, 0.5 * torsion.stiffness * torsion.twist * torsion.twist - 1e-15);
    }
    EXPECT_GT(put_in, 0.0);
}

TEST(SoftFinger, TremblingForceLoosensNothing) {
    Torsion torsion;
    turn_in_grip(torsion, {0.03, 0.02}, 5e-4);
    const double torque = torsion.stiffness * torsion.twist;
    for (int i = 0; i < 1'000; ++i) {
        const double at_rest = 0.03 - 0.01 * (i % 2);
        turn_in_grip(torsion, {at_rest, 0.7 * at_rest}, 0.0);
    }
    EXPECT_EQ(torsion.stiffness * torsion.twist, torque);
}

TEST(SoftFinger, AGripGoesOnWithItsBodyAndNormal) {
    TorsionList list;
    Torsion torsion;
    torsion.body = 3;
    torsion.twist = 0.5;
    list.add(torsion);
    EXPECT_EQ(list.grip_of(3, glm::normalize(up + Vec3(0.1, 0.0, 0.0))).twist, 0.5);
    EXPECT_EQ(list.grip_of(4, up).twist, 0.0);
    EXPECT_EQ(list.grip_of(3, -up).twist, 0.0);
    EXPECT_EQ(list.grip_of(4, up).body, 4);
}

}  // namespace
}  // namespace tactus::soft_finger_test
