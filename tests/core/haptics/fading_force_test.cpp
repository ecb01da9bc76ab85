#include "core/haptics/fading_force.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "shared/random_values.hpp"

namespace tactus::fading_force_test {
namespace {

using shared::RandomValues;

const Vec3 up(0.0, 1.0, 0.0);

constexpr double no_limit = 1e9;
constexpr FadingForce::Step still{};

TEST(FadingForce, MotionIsFeltAsItIs) {
    FadingForce fading;
    for (int i = 0; i < 10; ++i) {
        const Vec3 force = 3.0 * i * up;
        EXPECT_EQ(fading.felt(force, 8.0, false, still), force);  // the device limits what is too much
    }
}

TEST(FadingForce, ASurfaceThatVanishesLetsGoStepByStep) {
    FadingForce fading;
    fading.felt(5.0 * up, no_limit, false, still);
    double before = 5.0;
    for (int i = 0; i < 20; ++i) {
        const double felt = fading.felt(Vec3(0.0), no_limit, i == 0, still).y;
        EXPECT_NEAR(before - felt, FadingForce::max_step, 1e-12) << i;
        before = felt;
    }
    EXPECT_EQ(fading.felt(Vec3(0.0), no_limit, false, still), Vec3(0.0));
    EXPECT_EQ(fading.offset(), Vec3(0.0));
}

TEST(FadingForce, WhatTheDeviceDidNotGiveNeedNotFade) {
    FadingForce fading;
    fading.felt(500.0 * up, 8.0, false, still);
    EXPECT_NEAR(fading.felt(Vec3(0.0), 8.0, true, still).y, 8.0 - FadingForce::max_step, 1e-12);
}

TEST(FadingForce, WhatTheHandItselfDoesIsNotHeldBack) {
    FadingForce fading;
    FadingForce::Step step{Vec3(0.0), Vec3(0.0), 1000.0, 2.0};
    fading.felt(Vec3(0.0), no_limit, false, step);
    step.hand.y = -0.002;
    EXPECT_NEAR(fading.felt(2.0 * up, no_limit, true, step).y, 2.0, 1e-12);  // it went in just then
    step.velocity.y = -0.5;
    EXPECT_NEAR(fading.felt(9.0 * up, no_limit, true, step).y, 3.0, 1e-12);
}

// Dragged 11 mm deep from 500 to 5000 N/m, its proxy beside it: however fast, nothing of that is the hand's
// own doing.
TEST(FadingForce, AHandThatIsDraggedOntoAStifferPlaceFeelsItGrow) {
    for (const double meters_a_tick : {1e-4, 5e-4, 1e-3}) {
        FadingForce fading;
        FadingForce::Step step{Vec3(0.0), Vec3(0.0), 500.0, 0.0};
        step.proxy = 0.011 * up;
        Vec3 felt = fading.felt(5.5 * up, no_limit, false, step);
        for (int i = 0; i < 300; ++i) {
            step.hand.x += meters_a_tick;
            step.proxy.x += meters_a_tick;
            step.stiffness = 5000.0;
            const Vec3 before = felt;
            felt = fading.felt(55.0 * up, no_limit, i == 0, step);
            EXPECT_LE(glm::distance(before, felt), FadingForce::max_step + 1e-9)
                << meters_a_tick << ", " << i;
        }
        EXPECT_NEAR(felt.y, 55.0, 1e-9);
    }
}

// It goes deeper in the same tick: that is its own doing, and no more.
TEST(FadingForce, AHandThatAlsoGoesDeeperFeelsThatAtOnce) {
    FadingForce fading;
    FadingForce::Step step{Vec3(0.0), Vec3(0.0), 500.0, 0.0};
    step.proxy = 0.011 * up;
    fading.felt(5.5 * up, no_limit, false, step);
    step.hand = {1e-3, -2e-4, 0.0};
    step.proxy.x += 1e-3;
    step.stiffness = 5000.0;
    EXPECT_NEAR(fading.felt(56.0 * up, no_limit, true, step).y, 5.5 + 5000.0 * 2e-4, 1e-9);
}

// The proxy is put elsewhere, and the hand is at rest.
TEST(FadingForce, AProxyThatJumpsIsNotTheHandsDoing) {
    FadingForce fading;
    FadingForce::Step step{Vec3(0.0), Vec3(0.0), 500.0, 0.0};
    fading.felt(Vec3(0.0), no_limit, false, step);
    step.proxy.y += 0.01;
    EXPECT_NEAR(fading.felt(5.0 * up, no_limit, true, step).y, FadingForce::max_step, 1e-12);
}

// A body has appeared over the hand, which leaves at once, at half a newton a tick.
TEST(FadingForce, WhoLeavesWhileItFadesInIsNotDrawnBack) {
    FadingForce fading;
    FadingForce::Step step{Vec3(0.0), Vec3(0.0), 500.0, 0.0};
    fading.felt(Vec3(0.0), no_limit, false, step);
    for (int i = 0; i < 24; ++i) {
        step.hand.y += 1e-3;
        const Vec3 felt = fading.felt(std::max(0.0, 8.0 - 0.5 * i) * up, no_limit, i == 0, step);
        EXPECT_GE(felt.y, i < 16 ? -1e-12 : -0.25) << i;  // in the air there is no direction to go by
        EXPECT_LE(felt.y, 0.5) << i;
    }
    EXPECT_FALSE(fading.fades());
}

// A spring lets go at an edge, and the hand goes with the force, however slowly or fast: it gets no more work
// than the spring held, and no kick.
TEST(FadingForce, WhatLetGoGivesNoMoreThanItsSpringHeld) {
    for (const double stiffness : {500.0, 3000.0}) {
        for (const double meters_a_tick : {1e-5, 1e-4, 1e-3}) {
            FadingForce fading;
            FadingForce::Step step{Vec3(0.0), Vec3(0.0), stiffness, 0.0};
            Vec3 felt = fading.felt(60.0 * up, no_limit, false, step);
            step.stiffness = 0.0;
            double work = 0.0;
            for (int i = 0; i < 1000; ++i) {
                const Vec3 before = felt;
                felt = fading.felt(Vec3(0.0), no_limit, i == 0, step);
                EXPECT_LE(glm::distance(before, felt),
                          std::max(FadingForce::max_step, stiffness * meters_a_tick) + 1e-9);
                const Vec3 way = meters_a_tick * glm::normalize(Vec3(0.3, 1.0, 0.0));
                step.hand += way;
                work += glm::dot(felt, way);
            }
            const double held = 0.5 * 60.0 * 60.0 / stiffness;
            const double by_the_hold = 0.5 * 60.0 * meters_a_tick;  // the device holds each force for a tick
            EXPECT_LE(work, held + by_the_hold) << stiffness << " N/m, " << meters_a_tick;
        }
    }
}

// What lingers of a force that has gone is not cut short by another one that grows against it.
TEST(FadingForce, WhatLingersIsNotCutByAForceAgainstIt) {
    FadingForce fading;
    fading.felt(4.0 * up, no_limit, false, still);
    Vec3 felt = fading.felt(Vec3(0.0), no_limit, true, still);
    for (int i = 1; i <= 40; ++i) {
        const Vec3 now = fading.felt(-0.1 * i * up, no_limit, false, still);
        EXPECT_LE(glm::length(now - felt), FadingForce::max_step + 0.1 + 1e-9) << i;
        felt = now;
    }
}

TEST(FadingForce, WhereADeviceScalesForcesItFadesByAsMuchOfTheDevices) {
    FadingForce fading;
    FadingForce::Step step;
    step.fade = 0.1;
    fading.felt(5.0 * up, no_limit, false, step);
    EXPECT_NEAR(fading.felt(Vec3(0.0), no_limit, true, step).y, 4.9, 1e-12);
    EXPECT_TRUE(fading.fades());
    step.fade = 0.0;  // it waits
    EXPECT_NEAR(fading.felt(Vec3(0.0), no_limit, false, step).y, 4.9, 1e-12);
}

TEST(FadingWrench, ForceAndTorqueFadeEachByItsOwnStep) {
    FadingWrench fading;
    FadingForce::Step turn;
    turn.fade = FadingWrench::max_torque_step;
    fading.felt({2.0 * up, 0.5 * up}, no_limit, false, still, turn);
    for (int i = 1; i <= 50; ++i) {
        const Wrench felt = fading.felt({}, no_limit, i == 1, still, turn);
        EXPECT_NEAR(felt.force.y, std::max(0.0, 2.0 - i * FadingForce::max_step), 1e-12) << i;
        EXPECT_NEAR(felt.torque.y, std::max(0.0, 0.5 - i * FadingWrench::max_torque_step), 1e-12) << i;
    }
    EXPECT_FALSE(fading.fades());
}

// Whatever jumps how often: no step is larger than the motion's own and the fading's.
TEST(FadingForce, RandomChangesOneUponAnother) {
    RandomValues random(17);
    FadingForce fading;
    Vec3 force(0.0), felt(0.0);
    for (int i = 0; i < 20'000; ++i) {
        const bool jumped = random.below(20) == 0;
        force = jumped ? random.in_ball(40.0) : force + random.in_ball(0.1);
        const Vec3 now = fading.felt(force, no_limit, jumped, still);
        ASSERT_LE(glm::length(now - felt), FadingForce::max_step + 0.1 + 1e-9) << i;
        felt = now;
    }
    for (int i = 0; i < 1'000; ++i) {
        felt = fading.felt(force, no_limit, false, still);
    }
    EXPECT_EQ(felt, force);
}

}  // namespace
}  // namespace tactus::fading_force_test
