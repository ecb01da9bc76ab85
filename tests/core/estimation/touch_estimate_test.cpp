#include "core/estimation/touch_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "shared/touched_block.hpp"

namespace tactus::touch_estimate_test {
namespace {

using shared::touch_block;
using shared::TouchedBlock;

TEST(TouchEstimate, LearnsWhatIsTouchedWithinTwoSeconds) {
    std::uint64_t seed = 1;
    for (const double stiffness : {300.0, 1000.0, 3000.0}) {
        for (const double friction : {0.2, 0.8}) {
            for (const double mass : {0.2, 1.5}) {
                TouchedBlock block;
                block.stiffness = stiffness;
                block.friction = friction;
                block.mass = mass;
                block.seed = seed++;
                const TouchEstimate estimate = touch_block(block, 2.0);
                EXPECT_TRUE(estimate.stiffness().known);
                EXPECT_NEAR(estimate.stiffness().value, stiffness, 0.1 * stiffness);
                EXPECT_TRUE(estimate.friction().known);
                EXPECT_NEAR(estimate.friction().value, friction, 0.1 * friction);
                EXPECT_NEAR(estimate.mass().value, mass, 0.1 * mass) << stiffness << ' ' << friction;
            }
        }
    }
}

TEST(TouchEstimate, SaysHowSureItIs) {
    TouchedBlock block;
    int within = 0;
    constexpr int tries = 40;
    for (int i = 0; i < tries; ++i) {
        block.seed = 100u + static_cast<unsigned>(i);
        const TouchValue stiffness = touch_block(block, 0.4).stiffness();
        within += std::abs(stiffness.value - block.stiffness) < 3.0 * stiffness.deviation;
    }
    EXPECT_GE(within, 36);
}

TEST(TouchEstimate, MoreTouchMakesSurer) {
    const TouchedBlock block;
    EXPECT_LT(touch_block(block, 0.5).stiffness().deviation, touch_block(block, 0.2).stiffness().deviation);
    EXPECT_LT(touch_block(block, 2.0).mass().deviation, touch_block(block, 1.0).mass().deviation);
}

TEST(TouchEstimate, NothingIsKnownBeforeItIsTouched) {
    const TouchEstimate estimate;
    EXPECT_FALSE(estimate.stiffness().known);
    EXPECT_FALSE(estimate.friction().known);
    EXPECT_FALSE(estimate.mass().known);
}

// Neither sliding nor moving: only how stiff it is can be felt.
TEST(TouchEstimate, AStillTipLearnsNeitherFrictionNorMass) {
    TouchEstimate estimate;
    for (int i = 0; i < 2000; ++i) {
        TipSample sample;
        const double deep = 0.004 + 0.002 * std::sin(0.02 * i);
        sample.tip = {0.0, -deep, 0.0};
        sample.force = {0.3, -500.0 * deep, 0.0};
        estimate.feel(sample);
    }
    EXPECT_TRUE(estimate.stiffness().known);
    EXPECT_FALSE(estimate.friction().known);
    EXPECT_FALSE(estimate.mass().known);
}

TEST(TouchEstimate, NonsenseTeachesNothing) {
    TouchEstimate estimate = touch_block({}, 1.0);
    const double before = estimate.stiffness().value;
    TipSample sample;
    sample.force = {0.0, -std::nan(""), 0.0};
    estimate.feel(sample);
    sample.force = {0.0, -5.0, 0.0};
    sample.tip = {0.0, INFINITY, 0.0};
    estimate.feel(sample);
    EXPECT_EQ(estimate.stiffness().value, before);
}

}  // namespace
}  // namespace tactus::touch_estimate_test
