// Effects against their closed forms, and the work that the passive ones do.
#include "core/haptics/hand_effect.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

namespace tactus::hand_effect_test {
namespace {

using Form = HandEffect::Form;

constexpr double exact = 1e-9;  // (unit: newtons)
constexpr Nanoseconds tick = 1'000'000;
constexpr Form passive[] = {Form::spring, Form::damper, Form::friction, Form::detent, Form::wall};

HandEffect effect_of(Form form) {
    HandEffect effect;
    effect.form = form;
    effect.place = {0.01, -0.02, 0.03};
    effect.direction = glm::normalize(Vec3(1.0, 2.0, -2.0));
    effect.force = 1.5;
    effect.first_force = -0.5;
    effect.stiffness = 300.0;
    effect.damping = 4.0;
    effect.period = 0.013;
    effect.phase = 0.7;
    effect.duration = 0.4;
    effect.pitch = 0.008;
    return effect;
}

// A closed way, and the velocity on it; it comes back to its start once in a second.
HandMotion on_the_way(double seconds) {
    const double w = 2.0 * std::numbers::pi;
    return {{0.03 * std::sin(w * seconds), 0.02 * std::sin(2.0 * w * seconds + 0.5),
             0.04 * std::cos(3.0 * w * seconds)},
            {0.03 * w * std::cos(w * seconds), 0.04 * w * std::cos(2.0 * w * seconds + 0.5),
             -0.12 * w * std::sin(3.0 * w * seconds)}};
}

// u, s and t of the header.
struct Expected {
    Vec3 along{0.0};
    double operator()(const HandEffect& effect, const HandMotion& hand, double seconds) const {
        const double s = glm::dot(hand.position - effect.place, along);
        switch (effect.form) {
            case Form::constant:
                return 1.5;
            case Form::sine:
                return 1.5 * std::sin(2.0 * std::numbers::pi / 0.013 * seconds + 0.7);
            case Form::ramp:
                return seconds < 0.4 ? -0.5 + 5.0 * seconds : 1.5;
            case Form::detent:
                return -1.5 * std::sin(2.0 * std::numbers::pi * s / 0.008);
            case Form::wall:
                return s < 0.0 ? std::max(0.0, -300.0 * s - 4.0 * glm::dot(hand.velocity, along)) : 0.0;
            default:
                return 0.0;
        }
    }
};

TEST(HandEffect, EachFormIsItsClosedForm) {
    for (const Form form :
         {Form::constant, Form::sine, Form::ramp, Form::detent, Form::wall, Form::spring, Form::damper}) {
        const HandEffect effect = effect_of(form);
        ASSERT_EQ(check_effect(effect), "");
        const Expected expected{effect.direction};
        HandEffectMemory memory;
        for (int i = 0; i < 1000; ++i) {
            const double seconds = 1e-3 * i;
            const HandMotion hand = on_the_way(seconds);
            const Vec3 force = effect_force(effect, hand, 5 * tick + i * tick, memory);
            const Vec3 wanted = form == Form::spring   ? -300.0 * (hand.position - effect.place)
                                : form == Form::damper ? -4.0 * hand.velocity
                                                       : expected(effect, hand, seconds) * effect.direction;
            ASSERT_LT(glm::distance(force, wanted), exact) << static_cast<int>(form) << " at " << seconds;
        }
    }
}

TEST(HandEffect, FrictionHoldsUntilItSlides) {
    const HandEffect effect = effect_of(Form::friction);
    HandEffectMemory memory;
    const Vec3 start{0.2, 0.0, 0.0};
    EXPECT_EQ(effect_force(effect, {start, {}}, 0, memory), Vec3(0.0));
    // 1.5 N at 300 N/m: it sticks for 5 mm, in any direction, and slides on with that force.
    for (const Vec3& way : {Vec3(0.004, 0.0, 0.0), Vec3(0.0, 0.0, -0.004)}) {
        EXPECT_LT(glm::distance(effect_force(effect, {start + way, {}}, 0, memory), -300.0 * way), exact);
    }
    EXPECT_LT(glm::distance(effect_force(effect, {start + Vec3(0.0, 0.05, 0.0), {}}, 0, memory),
                            Vec3(0.0, -1.5, 0.0)),
              exact);
    EXPECT_LT(glm::distance(effect_force(effect, {start + Vec3(0.0, 0.047, 0.0), {}}, 0, memory),
                            Vec3(0.0, -0.6, 0.0)),
              exact);
}

TEST(HandEffect, ThePassiveOnesGiveNoEnergyOverAClosedWay) {
    for (const Form form : passive) {
        const HandEffect effect = effect_of(form);
        HandEffectMemory memory;
        constexpr int steps = 20'000;
        double work = 0.0;
        Vec3 force(0.0);
        // Twice: friction begins the second round with the anchor that it ends it with.
        for (int i = 0; i <= 2 * steps; ++i) {
            const HandMotion hand = on_the_way(static_cast<double>(i) / steps);
            const Vec3 now = effect_force(effect, hand, i, memory);
            if (i > steps) {
                const Vec3 way = hand.position - on_the_way(static_cast<double>(i - 1) / steps).position;
                work += 0.5 * glm::dot(force + now, way);
            }
            force = now;
        }
        EXPECT_LT(work, 1e-6) << static_cast<int>(form);
        if (form == Form::damper || form == Form::friction || form == Form::wall) {
            EXPECT_LT(work, -1e-4) << static_cast<int>(form);
        }
    }
}

// Of any way of a hand, in no more steps than there are ticks.
TEST(HandEffect, FrictionGivesNoEnergyHoweverTheHandGoes) {
    std::mt19937 random(58);
    std::normal_distribution<double> step(0.0, 0.003);
    const HandEffect effect = effect_of(Form::friction);
    HandEffectMemory memory;
    HandMotion hand;
    double work = 0.0;
    Vec3 force = effect_force(effect, hand, 0, memory);
    for (int i = 0; i < 10'000; ++i) {
        const Vec3 way{step(random), step(random), step(random)};
        hand.position += way;
        const Vec3 now = effect_force(effect, hand, 0, memory);
        work += glm::dot(0.5 * (force + now), way);
        force = now;
    }
    EXPECT_LT(work, 0.0);
}

TEST(HandEffect, NoneIsSteeperThanItSays) {
    for (const Form form : {Form::spring, Form::friction, Form::detent, Form::wall}) {
        const HandEffect effect = effect_of(form);
        const double most = steepest(effect).stiffness;
        double found = 0.0;
        for (int i = 0; i < 5000; ++i) {
            const Vec3 place = on_the_way(2e-4 * i).position;
            HandEffectMemory memory;
            effect_force(effect, {place, {}}, 0, memory);
            const Vec3 before = effect_force(effect, {place, {}}, 0, memory);
            const Vec3 after = effect_force(effect, {place + 1e-6 * effect.direction, {}}, 0, memory);
            found = std::max(found, glm::distance(before, after) / 1e-6);
        }
        EXPECT_LE(found, 1.0001 * most) << static_cast<int>(form);
        EXPECT_GT(found, 0.9 * most) << static_cast<int>(form);
        EXPECT_NEAR(steepest(weakened(effect, 0.25, 0.5)).stiffness, 0.25 * most, 1e-9);
    }
    EXPECT_EQ(steepest(weakened(effect_of(Form::damper), 0.25, 0.5)).damping, 2.0);
}

TEST(HandEffect, WhatCannotBeComputedIsSaid) {
    HandEffect effect = effect_of(Form::wall);
    effect.direction = Vec3(0.0);
    EXPECT_NE(check_effect(effect), "");
    effect = effect_of(Form::friction);
    effect.stiffness = 0.0;
    EXPECT_NE(check_effect(effect), "");
    effect = effect_of(Form::sine);
    effect.period = 0.0;
    EXPECT_NE(check_effect(effect), "");
    effect = effect_of(Form::spring);
    effect.place.x = std::nan("");
    EXPECT_NE(check_effect(effect), "");
}

}  // namespace
}  // namespace tactus::hand_effect_test
