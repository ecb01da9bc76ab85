#include "core/math/body_motion.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tactus::body_motion_test {
namespace {

TEST(BodyMotion, SmallAnglesKeepTheirDigits) {
    const Quat from = glm::angleAxis(0.7, glm::normalize(Vec3(1.0, 2.0, 3.0)));
    const Quat to = glm::angleAxis(1e-9, Vec3(0.0, 1.0, 0.0)) * from;
    EXPECT_NEAR(angle_between(from, to), 1e-9, 1e-15);
}

TEST(BodyMotion, AQuaternionAndItsOppositeAreTheSameTurn) {
    const Quat from = glm::angleAxis(0.7, Vec3(0.0, 1.0, 0.0));
    EXPECT_NEAR(angle_between(from, -from), 0.0, 1e-15);
}

TEST(BodyMotion, TurnsByItsAngularVelocity) {
    const Quat turn = turn_by({0.0, 2.0, 0.0}, 0.25);
    EXPECT_NEAR(angle_between(turn, glm::angleAxis(0.5, Vec3(0.0, 1.0, 0.0))), 0.0, 1e-15);
    EXPECT_EQ(turn_by(Vec3(0.0), 1.0), Quat(1.0, 0.0, 0.0, 0.0));
}

TEST(BodyMotion, DisplacementTakesOnePoseToTheOther) {
    const Pose from{{1.0, 2.0, 3.0}, glm::angleAxis(0.3, Vec3(1.0, 0.0, 0.0))};
    const Pose to{{-1.0, 0.5, 2.0}, glm::angleAxis(1.3, Vec3(0.0, 0.0, 1.0))};
    const Pose reached = compose(displacement(from, to), from);
    EXPECT_NEAR(glm::length(reached.position - to.position), 0.0, 1e-14);
    EXPECT_NEAR(angle_between(reached.rotation, to.rotation), 0.0, 1e-14);
}

TEST(BodyMotion, DiffersAboveItsThresholdsOnly) {
    const MotionThreshold threshold;
    const BodyMotion a;
    BodyMotion b;
    b.pose.position.x = 0.9 * threshold.position;
    b.linear_velocity.y = 0.9 * threshold.linear_velocity;
    EXPECT_FALSE(differs(a, b, threshold));
    b.linear_velocity.y = 1.1 * threshold.linear_velocity;
    EXPECT_TRUE(differs(a, b, threshold));
    EXPECT_FALSE(poses_differ(a.pose, b.pose, threshold));
}

}  // namespace
}  // namespace tactus::body_motion_test
