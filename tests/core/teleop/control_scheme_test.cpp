#include "core/teleop/control_scheme.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tactus::control_scheme_test {
namespace {

// An operator that presses 2 mm into a ground at y = 0, whose far side is 1 mm higher.
StandInInput pressing() {
    StandInInput in;
    in.hand = {0.1, -0.002, 0.0};
    in.force = {0.0, 1.0, 0.0};
    in.own_hand = {0.1, 0.0, 0.0};
    in.own_proxy = {0.1, 0.001, 0.0};
    in.in_contact = true;
    in.stiffness = 500.0;
    in.seconds = 0.001;
    return in;
}

StandInSettings long_leash() {
    StandInSettings settings;
    settings.leash = 0.03;
    return settings;
}

TEST(ControlScheme, TheSpringGoesWhereTheHandIs) {
    const StandInInput in = pressing();
    EXPECT_EQ(stand_in_hand(ControlScheme::spring, {}, in), in.hand);
}

TEST(ControlScheme, PositionKeepsItsSpeedInFreeSpace) {
    StandInInput in = pressing();
    in.in_contact = false;
    in.own_hand = {0.0, -0.002, 0.0};
    const Vec3 reached = stand_in_hand(ControlScheme::position, {}, in);
    EXPECT_NEAR(reached.x, 0.001, 1e-15);
    in.in_contact = true;
    EXPECT_EQ(stand_in_hand(ControlScheme::position, {}, in), in.hand);
}

TEST(ControlScheme, PositionAndForceAppliesTheForceThatTheOperatorFelt) {
    const StandInInput in = pressing();
    const Vec3 hand = stand_in_hand(ControlScheme::position_force, long_leash(), in);
    EXPECT_NEAR(in.stiffness * (in.own_proxy.y - hand.y), 1.0, 1e-12);
    EXPECT_EQ(hand.x, in.hand.x);
}

TEST(ControlScheme, WithoutContactThePositionCounts) {
    StandInInput in = pressing();
    in.in_contact = false;
    EXPECT_EQ(stand_in_hand(ControlScheme::position_force, {}, in), in.hand);
}

TEST(ControlScheme, NearAnObjectThePlaceRelativeToItCounts) {
    StandInInput in = pressing();
    in.in_contact = false;
    in.object.position = {0.11, 0.0, 0.0};
    in.relative = Vec3(0.0, 0.0, 0.0);
    const Vec3 hand = stand_in_hand(ControlScheme::position_force_relative, long_leash(), in);
    EXPECT_NEAR(glm::length(hand - in.object.position), 0.0, 1e-12);
}

TEST(ControlScheme, AForceLeadsTheHandNoFartherThanTheLeash) {
    StandInInput in = pressing();
    in.force = {0.0, 1e6, 0.0};
    const StandInSettings settings;
    const Vec3 hand = stand_in_hand(ControlScheme::position_force, settings, in);
    EXPECT_NEAR(glm::length(hand - in.hand), settings.leash, 1e-12);
}

}  // namespace
}  // namespace tactus::control_scheme_test
