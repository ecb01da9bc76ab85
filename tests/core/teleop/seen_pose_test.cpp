#include "core/teleop/seen_pose.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"
#include "shared/poses.hpp"
#include "shared/rough_eyes.hpp"

namespace tactus::seen_pose_test {
namespace {

using shared::at;
using shared::RoughEyes;

PoseDoubt doubt_of(double place, double turn) {
    return {Mat3(place * place), Mat3(turn * turn)};
}

TEST(SeenPose, WhatChanceExplainsChangesNothing) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        SeenPose eyes;
        RoughEyes seen(1e-3, 5e-3, seed);
        const Pose truth = at({0.1, 0.2, 0.3}, turn_by({0.3, 0.2, 0.1}, 1.0));
        for (int i = 0; i < 3000; ++i) {
            const Pose believed = eyes.believe({}, seen.see(truth), doubt_of(1e-3, 5e-3), truth, 0.0, 0.0);
            ASSERT_EQ(believed.position, truth.position) << seed << ' ' << i;
            ASSERT_EQ(believed.rotation, truth.rotation) << seed << ' ' << i;
        }
    }
}

TEST(SeenPose, ASureOneIsTakenAtOnceAndToTheBit) {
    SeenPose eyes;
    const Pose truth = at({0.1, 0.2, 0.3}, turn_by({0.0, 0.01, 0.0}, 1.0));
    const Pose believed = eyes.believe({}, truth, {}, at({0.1, 0.2, 0.299}), 0.0, 0.0);
    EXPECT_EQ(believed.position, truth.position);
    EXPECT_EQ(believed.rotation, truth.rotation);
}

// A jump at once; what is off by less than one look can tell, after some.
TEST(SeenPose, WhatIsReallyOffIsPutRight) {
    for (const double off : {0.02, 0.003}) {
        SeenPose eyes;
        RoughEyes seen(1e-3, 5e-3);
        const Pose truth = at({0.0, 0.0, 0.0});
        Pose model = truth;
        int put_right = -1;
        for (int i = 0; i < 400; ++i) {
            if (i == 100) {
                model.position.x = off;
            }
            const Pose believed = eyes.believe({}, seen.see(truth), doubt_of(1e-3, 5e-3), model, 0.0, 0.0);
            if (i >= 100 && put_right < 0 && believed.position != model.position) {
                put_right = i - 100;
            }
            model.position = believed.position;
        }
        EXPECT_GE(put_right, 0) << off;
        EXPECT_LT(put_right, off > 0.01 ? 2 : 200) << off;
        EXPECT_LT(glm::length(model.position), 2e-3) << off;
    }
}

// Of a cylinder nobody sees how it is turned about its axis; that it lies, everybody.
TEST(SeenPose, AnAxisThatIsNotSeenDoesNotHideTheOthers) {
    PoseDoubt doubt = doubt_of(1e-4, 1e-3);
    doubt.turn[1][1] = 0.09;
    const Pose standing = at({0.0, 0.0, 0.0});
    SeenPose eyes;
    const Pose spun =
        eyes.believe({}, at({0.0, 0.0, 0.0}, turn_by({0.0, 0.5, 0.0}, 1.0)), doubt, standing, 0.0, 0.0);
    EXPECT_EQ(spun.rotation, standing.rotation);
    const Quat tilt = turn_by({0.05, 0.0, 0.0}, 1.0);
    const Pose tilted = eyes.believe({}, at({0.0, 0.0, 0.0}, tilt), doubt, standing, 0.0, 0.0);
    EXPECT_LT(angle_between(tilted.rotation, tilt), 1e-3);
}

TEST(SeenPose, OnlyCovariancesAreSound) {
    EXPECT_TRUE(is_sound({}));
    EXPECT_TRUE(is_sound(turned(doubt_of(1e-3, 0.3), turn_by({0.3, 0.2, 0.1}, 1.0))));
    PoseDoubt doubt = doubt_of(1e-3, 0.1);
    doubt.place[0][1] = doubt.place[1][0] = 2e-6;
    EXPECT_FALSE(is_sound(doubt));
    EXPECT_FALSE(is_sound({Mat3(-1.0), Mat3(1.0)}));
    EXPECT_FALSE(is_sound({Mat3(std::nan("")), Mat3(1.0)}));
    EXPECT_FALSE(is_sound({Mat3(1.0), Mat3(1e3)}));
}

}  // namespace
}  // namespace tactus::seen_pose_test
