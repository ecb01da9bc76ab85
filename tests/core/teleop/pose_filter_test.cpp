#include "core/teleop/pose_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"
#include "shared/poses.hpp"
#include "shared/rough_eyes.hpp"

namespace tactus::pose_filter_test {
namespace {

using shared::at;
using shared::RoughEyes;

PoseStep step_of(const Vec3& way, double open_way = 0.0) {
    PoseStep step;
    step.way = way;
    step.open_way = open_way;
    return step;
}

TEST(PoseFilter, AnHonestFarSideIsBelievedToTheBit) {
    PoseFilter filter;
    FarEyes eyes;
    Vec3 before(0.0);
    for (int i = 0; i < 500; ++i) {
        const Vec3 place(0.001 * i, std::sin(0.1 * i) * 1e-3, 0.0);
        const Quat turned = turn_by({0.0, 0.01 * i, 0.0}, 1.0);
        PoseStep step = step_of(place - before + Vec3(2e-5, 0.0, 1e-5));
        step.turn = turn_by({0.0, i > 0 ? 0.01 : 0.0, 0.0}, 1.0);
        const Pose believed =
            filter.filter({}, at(place, turned), at(place + Vec3(1e-4, 0.0, 0.0)), step, eyes);
        EXPECT_EQ(believed.position, place);
        EXPECT_EQ(believed.rotation, turned);
        before = place;
    }
}

TEST(PoseFilter, ABodyThatIsReallyElsewhereIsBelievedAtOnce) {
    PoseFilter filter;
    FarEyes eyes;
    RoughEyes rough(1e-3, 0.0);
    for (int i = 0; i < 200; ++i) {
        filter.filter({}, rough.see(at(Vec3(0.0))), at(Vec3(0.0)), {}, eyes);
    }
    const Pose there = at({0.2, 0.0, 0.0});
    EXPECT_EQ(filter.filter({}, there, at(Vec3(0.0)), {}, eyes).position, there.position);
}

TEST(PoseFilter, ACorrectionThatChanceExplainsIsNotMade) {
    PoseFilter filter;
    FarEyes eyes;
    RoughEyes rough(1e-3, 5e-3);
    const Pose model = at({0.1, 0.2, 0.3}, turn_by({0.3, 0.0, 0.1}, 1.0));
    for (int i = 0; i < 1000; ++i) {
        const Pose believed = filter.filter({}, rough.see(model), model, {}, eyes);
        if (i > 20) {
            EXPECT_LT(glm::distance(believed.position, model.position), 1e-12) << i;
            EXPECT_LT(angle_between(believed.rotation, model.rotation), 1e-12) << i;
        }
    }
}

// Another body's joint shows the chance before any body has had a second state.
TEST(PoseFilter, AStillBodyKeepsTheModelAfterAPoseThatNoJointAllows) {
    const Pose hinged = at({1.0, 0.0, 0.0});
    const Pose model = at({0.1, 0.2, 0.3}, turn_by({0.3, 0.0, 0.1}, 1.0));
    double warned_off = 0.0, off = 0.0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        PoseFilter warned, unwarned;
        FarEyes warned_eyes, eyes;
        RoughEyes rough(1e-3, 5e-3, seed);
        warned_eyes.note_forbidden({}, rough.see(hinged), hinged);
        for (int i = 0; i < 8; ++i) {
            const Pose seen = rough.see(model);
            const Pose believed = warned.filter({}, seen, model, {}, warned_eyes);
            warned_off += glm::distance(believed.position, model.position);
            off += glm::distance(unwarned.filter({}, seen, model, {}, eyes).position, model.position);
            if (i == 0) {
                EXPECT_LT(glm::distance(believed.position, model.position), 1e-12) << seed;
                EXPECT_LT(angle_between(believed.rotation, model.rotation), 1e-9) << seed;
            }
        }
    }
    EXPECT_LT(warned_off, 0.5 * off);
}

TEST(PoseFilter, PosesThatNoJointAllowsTellTheChance) {
    FarEyes eyes;
    RoughEyes rough(1e-3, 5e-3, 3);
    const Pose hinged = at({1.0, 0.0, 0.0});
    for (int i = 0; i < 100; ++i) {
        eyes.note_forbidden({}, rough.see(hinged), hinged);
    }
    EXPECT_NEAR(std::sqrt(eyes.place.variance()), 1e-3, 5e-4);
    EXPECT_NEAR(std::sqrt(eyes.turn.variance()), 5e-3, 2.5e-3);
    EXPECT_EQ(eyes.place.count, 8.0) << "what bodies teach themselves counts from then on";
}

TEST(PoseFilter, AStillBodyOfAnHonestFarSideIsBelievedAtOnce) {
    PoseFilter filter;
    FarEyes eyes;
    const Pose there = at({0.2, 0.0, 0.0}, turn_by({0.3, 0.0, 0.1}, 1.0));
    const Pose believed = filter.filter({}, there, at(Vec3(0.0)), {}, eyes);
    EXPECT_EQ(believed.position, there.position);
    EXPECT_EQ(believed.rotation, there.rotation);
}

// What the way leaves open makes the belief follow what is seen by a hair, each time: no reason to put a body
// off the ground that it stands on.
TEST(PoseFilter, AModelThatIsNearEnoughStaysAsItIs) {
    FarEyes eyes;
    PoseFilter filter;
    RoughEyes rough(1e-3, 5e-3);
    const Pose model = at({0.1, 0.2, 0.3}, turn_by({0.3, 0.0, 0.1}, 1.0));
    PoseStep step = step_of(Vec3(0.0), 5e-5);
    step.open_turn = 2e-4;
    int kept = 0, followed = 0;
    for (int i = 0; i < 1000; ++i) {
        const Pose believed = filter.filter({}, rough.see(model), model, step, eyes);
        followed += believed.position != model.position ? 1 : 0;
        const Pose result = filter.unless_said({}, believed, model, eyes);
        kept += result.position == model.position && result.rotation == model.rotation ? 1 : 0;
    }
    EXPECT_GT(followed, 900);
    EXPECT_GT(kept, 900);
    const Pose elsewhere = at({0.101, 0.2, 0.3}, model.rotation);
    EXPECT_NE(filter.unless_said({}, model, elsewhere, eyes).position, elsewhere.position);
}

TEST(PoseFilter, WhatOneBodyHasTaughtCountsForTheNext) {
    FarEyes eyes;
    RoughEyes rough(1e-3, 0.0);
    PoseFilter first, second;
    for (int i = 0; i < 50; ++i) {
        first.filter({}, rough.see(at(Vec3(0.0))), at(Vec3(0.0)), {}, eyes);
    }
    const Pose model = at({1.0, 0.0, 0.0});
    EXPECT_LT(glm::distance(second.filter({}, rough.see(model), model, {}, eyes).position, model.position),
              1e-12);
}

// Mean distance from the truth of a body that the model has 30 mm elsewhere, and whose way is told `told`
// times as long as it is.
double error_with_chance(double deviation, const Vec3& velocity, double told, bool begins_late = false) {
    constexpr double between = 0.005;
    constexpr int states = 4000;
    PoseFilter filter;
    FarEyes eyes;
    RoughEyes rough(deviation, 0.0), fine(0.0, 0.0);
    Vec3 truth(0.0);
    double sum = 0.0;
    for (int i = 0; i < states; ++i) {
        truth += velocity * between;
        const Pose seen = (begins_late && i < 1000 ? fine : rough).see(at(truth));
        const PoseStep step = step_of(velocity * between * told);
        const Pose believed = filter.filter({}, seen, at(truth + Vec3(0.03, 0.0, 0.0)), step, eyes);
        sum += i >= states / 2 ? glm::distance(believed.position, truth) : 0.0;
    }
    return sum / (states / 2);
}

TEST(PoseFilter, ChanceIsTakenOutOfWhatRestsAndOfWhatMoves) {
    constexpr double deviation = 1e-3;
    const double unfiltered = deviation * std::sqrt(8.0 / 3.14159265358979);
    EXPECT_LT(error_with_chance(deviation, Vec3(0.0), 1.0), 0.05 * unfiltered);
    EXPECT_LT(error_with_chance(deviation, {0.2, 0.0, 0.0}, 1.0), 0.05 * unfiltered);
    EXPECT_LT(error_with_chance(deviation, {0.2, 0.0, 0.0}, 1.0, true), 0.1 * unfiltered);
}

TEST(PoseFilter, AWayThatIsToldTooLongIsFoundOut) {
    constexpr double deviation = 1e-3;
    EXPECT_LT(error_with_chance(deviation, {0.2, 0.0, 0.0}, 1.02), 1.5 * deviation);
    EXPECT_LT(error_with_chance(deviation, {0.2, 0.0, 0.0}, 1.2), 3.0 * deviation);
}

TEST(PoseFilter, AWayThatIsOpenIsSeen) {
    constexpr double between = 0.005;
    PoseFilter filter;
    FarEyes eyes;
    RoughEyes rough(1e-3, 0.0);
    Vec3 truth(0.0);
    double sum = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const double velocity = i % 100 < 50 ? 0.3 : -0.3;
        truth.x += velocity * between;
        const Pose believed =
            filter.filter({}, rough.see(at(truth)), at(truth), step_of(Vec3(0.0), 0.3 * between), eyes);
        sum += glm::distance(believed.position, truth);
    }
    EXPECT_LT(sum / 2000, 2e-3);
}

}  // namespace
}  // namespace tactus::pose_filter_test
