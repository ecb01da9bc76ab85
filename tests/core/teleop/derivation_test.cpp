// A body that moves in a known way, known late: which derivation finds the present.
#include "core/teleop/derivation.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tactus::derivation_test {
namespace {

constexpr double late = 0.1;

// x(t) = 2 + 0.3 t + a t^2 / 2, turning about y with 1 + b t.
BodyMotion moving(double time, double a, double b) {
    BodyMotion motion;
    motion.pose.position.x = 2.0 + 0.3 * time + 0.5 * a * time * time;
    motion.pose.rotation = glm::angleAxis(time + 0.5 * b * time * time, Vec3(0.0, 1.0, 0.0));
    motion.linear_velocity.x = 0.3 + a * time;
    motion.angular_velocity.y = 1.0 + b * time;
    return motion;
}

DerivationInput seen_late(double a, double b) {
    DerivationInput in;
    in.received = moving(0.0, a, b);
    in.own_then = moving(0.0, a, b);
    in.own_now = moving(late, a, b);
    in.seconds = late;
    in.linear_acceleration.x = a;
    in.angular_acceleration.y = b;
    return in;
}

double off(const BodyMotion& found, double a, double b) {
    const BodyMotion now = moving(late, a, b);
    return glm::length(found.pose.position - now.pose.position) +
           angle_between(found.pose.rotation, now.pose.rotation) +
           glm::length(found.linear_velocity - now.linear_velocity) +
           glm::length(found.angular_velocity - now.angular_velocity);
}

TEST(Derivation, NoneLagsBehind) {
    EXPECT_EQ(derive(Derivation::none, seen_late(0.0, 0.0)).pose.position.x, 2.0);
}

TEST(Derivation, VelocityIsExactForSteadyMotion) {
    EXPECT_NEAR(off(derive(Derivation::velocity, seen_late(0.0, 0.0)), 0.0, 0.0), 0.0, 1e-14);
    EXPECT_GT(off(derive(Derivation::velocity, seen_late(2.0, 0.0)), 2.0, 0.0), 0.005);
}

TEST(Derivation, AccelerationIsExactForSteadyAcceleration) {
    EXPECT_NEAR(off(derive(Derivation::acceleration, seen_late(2.0, 3.0)), 2.0, 3.0), 0.0, 1e-14);
}

TEST(Derivation, AveragedTakesTheMeanRate) {
    DerivationInput in = seen_late(0.0, 0.0);
    in.own_then.linear_velocity.x = 0.5;
    EXPECT_NEAR(derive(Derivation::averaged, in).pose.position.x, 2.0 + 0.4 * late, 1e-14);
    EXPECT_EQ(derive(Derivation::averaged, in).linear_velocity, in.received.linear_velocity);
}

TEST(Derivation, HistoryIsExactWhereTheModelIsOffByAConstant) {
    DerivationInput in = seen_late(2.0, 3.0);
    in.own_then.pose.position.z += 0.02;
    in.own_now.pose.position.z += 0.02;
    EXPECT_NEAR(off(derive(Derivation::history, in), 2.0, 3.0), 0.0, 1e-14);
}

TEST(Derivation, ARightModelIsLeftAloneByHistory) {
    const DerivationInput in = seen_late(2.0, 3.0);
    const BodyMotion now = derive(Derivation::history, in);
    EXPECT_EQ(now.pose.position, in.own_now.pose.position);
    EXPECT_EQ(now.linear_velocity, in.own_now.linear_velocity);
}

TEST(Derivation, DoesNotExtrapolateWithoutEnd) {
    DerivationInput in = seen_late(0.0, 0.0);
    in.seconds = 100.0;
    EXPECT_NEAR(derive(Derivation::velocity, in).pose.position.x, 2.0 + 0.3 * in.max_extrapolation, 1e-14);
}

}  // namespace
}  // namespace tactus::derivation_test
