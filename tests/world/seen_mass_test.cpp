#include "world/seen_mass.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::seen_mass_test {
namespace {

constexpr double told = 0.5;  // (unit: kilograms)

// Of a hand that presses unevenly, beside a steady force.
SeenMass seen(double mass, double steady) {
    SeenMass found;
    for (int i = 0; i < 60; ++i) {
        const Vec3 impulse(0.02 + 0.01 * std::sin(0.3 * i), 0.0, 0.0);  // (unit: newton seconds)
        found.note(impulse, impulse / mass + Vec3(steady, 0.0, 0.0), told);
    }
    return found;
}

TEST(SeenMass, IsThatWhichPushesMove) {
    for (const double factor : {1.0, 2.0, 3.5}) {
        EXPECT_NEAR(seen(factor * told, 0.0).factor(), factor, 0.11 * factor) << factor;
        EXPECT_NEAR(seen(factor * told, -0.1).factor(), factor, 0.11 * factor) << factor;
    }
}

// A body that bounces off a finger touches it for a few frames in all.
TEST(SeenMass, IsSeenInTheFirstPush) {
    SeenMass found;
    found.note(Vec3(0.0), {-0.01, 0.0, 0.0}, told);  // what slows it besides
    const Vec3 impulse(-0.02, 0.0, 0.0);
    found.note(impulse, impulse / (2.5 * told) + Vec3(-0.01, 0.0, 0.0), told);
    EXPECT_NEAR(found.factor(), 2.5, 0.1);
}

TEST(SeenMass, IsNeverLessThanTheEngineSays) {
    EXPECT_EQ(seen(0.6 * told, 0.0).factor(), 1.0);
}

// As where a spring of the engine holds the body against a hand that rests.
TEST(SeenMass, ASteadyPushTellsNothing) {
    SeenMass found;
    for (int i = 0; i < 60; ++i) {
        found.note({0.02, 0.0, 0.0}, Vec3(0.0), told);
    }
    EXPECT_EQ(found.factor(), 1.0);
}

// A wall behind it, or friction.
TEST(SeenMass, WhatIsHeldIsNotHeavy) {
    SeenMass found;
    for (int i = 0; i < 60; ++i) {
        found.note({i % 2 == 0 ? 0.02 : 0.01, 0.0, 0.0}, Vec3(0.0), told);
    }
    EXPECT_EQ(found.factor(), 1.0);
}

// The first frame of a push may be off: a body that begins to slide is held for a part of it.
TEST(SeenMass, IsPutRightByTheNextPushes) {
    SeenMass found;
    found.note(Vec3(0.0), Vec3(0.0), told);
    for (int i = 0; i < 20; ++i) {
        const Vec3 impulse(0.02 + 0.01 * std::sin(0.3 * i), 0.0, 0.0);
        found.note(impulse, impulse / (i == 0 ? 1.101 * told : told), told);
    }
    EXPECT_NEAR(found.factor(), 1.0, 0.03);
}

}  // namespace
}  // namespace tactus::seen_mass_test
