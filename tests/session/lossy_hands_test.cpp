// A hand with a deadband over a link that loses packets, see shared/lossy_hands.hpp; all of its cases and
// seeds: ./run bench teleop --lossy=1.
#include "shared/lossy_hands.hpp"

#include <gtest/gtest.h>

namespace tactus::lossy_hands_test {
namespace {

using namespace shared;

// The hand comes to rest in one tick, so that a guess leads up to 25 ms farther.
void expect_no_more_than_the_operator(const std::string& ending) {
    int found = 0;
    for (const LossyCase& one : lossy_cases()) {
        if (!one.name.ends_with(ending)) {
            continue;
        }
        ++found;
        for (const std::uint64_t seed : {1u, 2u}) {
            SCOPED_TRACE(one.name + ", seed " + std::to_string(seed));
            const LossyFigures figures = run_lossy(one, seed);
            EXPECT_TRUE(figures.agreed);
            EXPECT_EQ(figures.touches, 0);
            EXPECT_EQ(figures.beyond, 0);
            EXPECT_EQ(figures.far_force > 1.0, one.presses);
            EXPECT_LE(figures.excess(), 1.0);
        }
    }
    EXPECT_EQ(found, 6) << "three hands, which stop or press";
}

TEST(LossyHands, HalfOfAllPacketsAreLost) {
    expect_no_more_than_the_operator("loss_50");
}

TEST(LossyHands, PacketsAreLostInBursts) {
    expect_no_more_than_the_operator("bursts_20");
}

TEST(LossyHands, NothingGetsThroughForAWhile) {
    expect_no_more_than_the_operator("outage_300ms");
}

// The model's hand begins inside the plate and feels nothing: nor does the far one press.
TEST(LossyHands, AHandThatComesBackInsideABodyPressesNothing) {
    for (const LossyHand hand : {LossyHand::fingertip, LossyHand::tool, LossyHand::robot}) {
        for (const Absence absence : {Absence::pointer, Absence::device, Absence::another_device}) {
            SCOPED_TRACE(static_cast<int>(hand) * 3 + static_cast<int>(absence));
            const AbsentFigures figures = run_absent(hand, absence);
            EXPECT_GT(figures.pressed, 1.0);
            EXPECT_LT(figures.away, 0.1);
            EXPECT_LT(figures.back.excess(), 0.1);
            EXPECT_LT(figures.lasting, 0.1);
        }
    }
}

// It is given no force meanwhile: the far hand presses by a newton, a robot by what its friction is not known
// by besides.
TEST(LossyHands, AHandWhoseClutchIsHeldHardlyPresses) {
    for (const LossyHand hand : {LossyHand::fingertip, LossyHand::tool, LossyHand::robot}) {
        for (const bool is_direct : {false, true}) {
            SCOPED_TRACE(std::to_string(static_cast<int>(hand)) + (is_direct ? ", direct" : ", model"));
            const AbsentFigures figures = run_absent(hand, Absence::clutch, is_direct);
            EXPECT_GT(figures.pressed, 3.5);
            EXPECT_LT(figures.away, hand == LossyHand::robot ? 1.9 : 1.2);
            EXPECT_NEAR(figures.lasting, figures.pressed, 0.1 * figures.pressed);
        }
    }
}

// The far hand is led straight on, into the post. A robot cannot begin elsewhere: its mass comes to a stop
// there, and what is left is what its friction is not known by.
TEST(LossyHands, AHandThatGoesAroundABodyDuringAnOutagePressesNothing) {
    for (const LossyHand hand : {LossyHand::fingertip, LossyHand::tool, LossyHand::robot}) {
        for (const double outage : {0.1, 0.3, 0.5, 0.9}) {
            SCOPED_TRACE(std::to_string(static_cast<int>(hand)) + ", " + std::to_string(outage));
            const AroundFigures figures = run_around(hand, outage);
            EXPECT_EQ(figures.own_force, 0.0);
            EXPECT_LT(figures.far_force, hand == LossyHand::robot ? 2.5 : 0.1);
            EXPECT_LT(figures.lasting, hand == LossyHand::robot ? 0.61 : 0.1);
        }
    }
}

}  // namespace
}  // namespace tactus::lossy_hands_test
