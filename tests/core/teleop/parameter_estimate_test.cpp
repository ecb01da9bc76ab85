#include "core/teleop/parameter_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace tactus::parameter_estimate_test {
namespace {

constexpr double gravity = 9.81;
constexpr double seconds = 0.005;

// A block of mass m that slides on a floor of friction mu, pushed along x.
struct Block {
    double mass, friction;
    double acceleration(double push) const { return push / mass - friction * gravity; }
};

// What `truth` does to a model of `believed`, with the factors learnt so far.
MotionLesson lesson(const Block& truth, const Block& believed, const ParameterEstimate& estimate,
                    double push) {
    const Block model{believed.mass * estimate.mass_factor(), believed.friction * estimate.friction_factor()};
    MotionLesson made;
    made.truth_before = made.model_before = {0.2, 0.0, 0.0};
    made.truth = made.truth_before + Vec3(truth.acceleration(push) * seconds, 0.0, 0.0);
    made.model = made.model_before + Vec3(model.acceleration(push) * seconds, 0.0, 0.0);
    made.pushed = {push / model.mass * seconds, 0.0, 0.0};
    made.seconds = seconds;
    return made;
}

TEST(ParameterEstimate, LearnsMassAndFrictionFromPushesThatVary) {
    const EstimateSettings settings;
    for (const double mass : {0.5, 0.8, 1.3, 2.0}) {
        for (const double friction : {0.5, 1.0, 1.5}) {
            const Block truth{0.3, 0.5};
            const Block believed{0.3 * mass, 0.5 * friction};
            ParameterEstimate estimate(settings);
            for (int i = 0; i < 200; ++i) {
                estimate.learn(settings, lesson(truth, believed, estimate, 1.5 + std::sin(0.3 * i)));
            }
            EXPECT_NEAR(estimate.mass_factor(), 1.0 / mass, 0.02);
            EXPECT_NEAR(estimate.friction_factor(), 1.0 / friction, 0.02);
        }
    }
}

// What a steady push teaches is the force that it takes, which is all that is felt.
TEST(ParameterEstimate, ASteadyPushTeachesTheForceItTakes) {
    const EstimateSettings settings;
    const Block truth{0.3, 0.5};
    const Block believed{0.36, 0.7};
    ParameterEstimate estimate(settings);
    const double push = 0.3 * 0.5 * gravity;
    for (int i = 0; i < 200; ++i) {
        estimate.learn(settings, lesson(truth, believed, estimate, push));
    }
    const Block model{believed.mass * estimate.mass_factor(), believed.friction * estimate.friction_factor()};
    EXPECT_NEAR(model.mass * model.friction * gravity, push, 0.02 * push);
}

// Ten bodies are pushed together, then one of them alone, and it is another than all of them are.
TEST(ParameterEstimate, WhatManySharedMakesNoneOfThemCertain) {
    const EstimateSettings settings;
    const Block together{0.3, 0.5}, alone{0.3, 0.25};
    const auto left = [&](double share) {
        ParameterEstimate estimate(settings);
        for (int i = 0; i < 50; ++i) {
            estimate.learn(settings, lesson(together, together, estimate, 1.5 + std::sin(0.3 * i)), share);
        }
        for (int i = 0; i < 20; ++i) {
            estimate.learn(settings, lesson(alone, together, estimate, 1.5 + std::sin(0.3 * i)));
        }
        return std::abs(estimate.friction_factor() - 0.5);
    };
    EXPECT_LT(left(0.1), 0.5 * left(1.0));
}

TEST(ParameterEstimate, WhatRestsTeachesNothing) {
    const EstimateSettings settings;
    ParameterEstimate estimate(settings);
    MotionLesson still;
    still.truth = {0.001, 0.0, 0.0};
    still.model = {0.5, 0.0, 0.0};
    still.seconds = seconds;
    estimate.learn(settings, still);
    EXPECT_TRUE(estimate.is_none());
}

// A block that slides on by itself, of more friction than believed.
TEST(ParameterEstimate, AFreeSlideIdentifiesFrictionWhereTheHandHasBegunIt) {
    const EstimateSettings settings;
    const Block truth{0.3, 0.7};
    const Block believed{0.3, 0.5};
    ParameterEstimate estimate(settings);
    for (int i = 0; i < 100; ++i) {
        estimate.learn(settings, lesson(truth, believed, estimate, 0.0));
    }
    EXPECT_TRUE(estimate.is_none()) << "something else has moved it, and may be at it still";
    estimate.learn(settings, lesson(believed, believed, estimate, 1.5));
    for (int i = 0; i < 100; ++i) {
        estimate.learn(settings, lesson(truth, believed, estimate, 0.0));
    }
    EXPECT_NEAR(estimate.friction_factor(), 1.4, 0.05);
}

// What acts besides, along the motion or against it (unit: newtons), is neither friction nor mass where none
// of that could make so much of a difference.
TEST(ParameterEstimate, WhatNoFactorsExplainIsLeftOut) {
    const EstimateSettings settings;
    const Block truth{0.3, 0.5};
    for (const double push : {0.0, 1.5}) {
        for (const double other : {8.0, -14.0}) {
            ParameterEstimate estimate(settings);
            estimate.learn(settings, lesson(truth, truth, estimate, 1.5));
            for (int i = 0; i < 100; ++i) {
                MotionLesson drawn = lesson(truth, truth, estimate, push);
                drawn.truth.x += other / truth.mass * seconds;
                estimate.learn(settings, drawn);
            }
            EXPECT_TRUE(estimate.is_none()) << push << ", " << other;
        }
    }
}

TEST(ParameterEstimate, NoLessonLeadsBeyondTheBoundOrToNonsense) {
    const EstimateSettings settings;
    ParameterEstimate estimate(settings);
    for (const double wild : {1e300, -1e300, 1e5, -1e5, std::nan(""), HUGE_VAL}) {
        MotionLesson odd;
        odd.truth_before = odd.model_before = odd.model = {0.2, 0.0, 0.0};
        odd.truth = {0.2 + wild, 0.0, 0.0};
        odd.pushed = {wild, 0.0, 0.0};
        odd.seconds = seconds;
        for (int i = 0; i < 100; ++i) {
            estimate.learn(settings, odd);
        }
        for (const double factor : {estimate.mass_factor(), estimate.friction_factor()}) {
            EXPECT_GE(factor, 1.0 / settings.largest - 1e-12);
            EXPECT_LE(factor, settings.largest + 1e-12);
        }
    }
}

TEST(ParameterEstimate, ARightModelLearnsNothing) {
    const EstimateSettings settings;
    const Block block{0.3, 0.5};
    ParameterEstimate estimate(settings);
    for (int i = 0; i < 100; ++i) {
        estimate.learn(settings, lesson(block, block, estimate, 1.0 + 0.01 * i));
    }
    EXPECT_NEAR(estimate.mass_factor(), 1.0, 1e-9);
    EXPECT_NEAR(estimate.friction_factor(), 1.0, 1e-9);
}

}  // namespace
}  // namespace tactus::parameter_estimate_test
