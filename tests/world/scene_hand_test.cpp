// The hand of a scene: which port it has, and where it goes that is led.
#include "world/scene_hand.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "devices/path_device.hpp"

namespace tactus::scene_hand_test {
namespace {

// Where the hand is, in the device's own frame, once it has had time to follow.
Vec3 place_of(const SceneHand& hand) {
    DeviceSample sample;
    for (int tick = 0; tick < 1000; ++tick) {
        sample = hand.port()->read(tick * Nanoseconds{1'000'000});
    }
    return sample.position;
}

void expect_at(const SceneHand& hand, const Vec3& place) {
    const Vec3 there = place_of(hand);
    EXPECT_LT(glm::distance(there, place), 1e-9) << there.x << ' ' << there.y << ' ' << there.z;
}

Workspace shifted() {
    Workspace mapping;
    mapping.pose.position = {1, 0, 0};
    mapping.scale = 2.0;
    return mapping;
}

TEST(SceneHand, ThereIsNoneAtFirst) {
    SceneHand hand;
    EXPECT_EQ(hand.port(), nullptr);
    EXPECT_FALSE(hand.is_led());
    hand.lead({{1, 2, 3}}, {}, 0);
    hand.steer({1, 0, 0}, {}, 0.1, {}, 0);
    hand.point({}, 0.0, {}, 0);
    hand.change(ArmSettings{});
    EXPECT_EQ(hand.health().text, "");
}

TEST(SceneHand, IsOfItsKind) {
    HandPlan plan;
    plan.kind = HandKind::path;
    EXPECT_NE(dynamic_cast<PathDevice*>(SceneHand(plan, {}).port().get()), nullptr);
    plan.kind = HandKind::arm;
    EXPECT_NE(dynamic_cast<SimulatedArm*>(SceneHand(plan, {}).port().get()), nullptr);
    plan.kind = HandKind::emulated_robot;
    const SceneHand robot(plan, {});
    EXPECT_NE(robot.port(), nullptr);
    EXPECT_FALSE(robot.is_led());
    for (const HandKind kind :
         {HandKind::mouse, HandKind::keyboard, HandKind::gamepad, HandKind::space_mouse, HandKind::node}) {
        plan.kind = kind;
        EXPECT_TRUE(SceneHand(plan, {}).is_led());
    }
}

TEST(SceneHand, ADriverIsMadeForEachKindThatHasOne) {
    for (const HandKind kind : {HandKind::force_dimension, HandKind::openhaptics, HandKind::inverse3}) {
        EXPECT_TRUE(has_driver(kind));
        HandPlan plan;
        plan.kind = kind;
        const SceneHand hand(plan, {});
        EXPECT_NE(dynamic_cast<DriverDevice*>(hand.port().get()), nullptr);
        EXPECT_EQ(hand.health().readings, 0u);
    }
    EXPECT_TRUE(has_driver(HandKind::falcon));
    EXPECT_FALSE(has_driver(HandKind::emulated_robot));
    EXPECT_FALSE(has_driver(HandKind::node));
}

TEST(SceneHand, BeginsAndIsLedInTheScene) {
    HandPlan plan;
    plan.kind = HandKind::node;
    plan.start = {1, 0, 4};
    SceneHand hand(plan, shifted());
    expect_at(hand, {0, 0, 2});
    hand.lead({{3, 0, 0}}, shifted(), 5);
    expect_at(hand, {1, 0, 0});
    EXPECT_EQ(hand.port()->read(2'000'000'000).buttons, 5u);
    hand.lead({{1e9, 0, 0}}, shifted(), 0);
    expect_at(hand, {1, 0, 0});
}

TEST(SceneHand, FollowsThePointerAtItsDepth) {
    HandPlan plan;
    plan.start = {0, 0, -1};
    SceneHand hand(plan, {});
    const Vec3 slanted = glm::normalize(Vec3(1, 0, -1));
    hand.point({{0, 0, 0}, slanted, {0, 0, -1}}, 0.0, {}, 0);
    expect_at(hand, {1, 0, -1});
    hand.point({{0, 0, 0}, {0, 0, -1}, {0, 0, -1}}, 0.5, {}, 1);
    expect_at(hand, {0, 0, -1.5});
    hand.point({{0, 0, 0}, {0, 0, 1}, {0, 0, -1}}, 0.0, {}, 1);
    expect_at(hand, {0, 0, -1.5});
}

TEST(SceneHand, IsSteeredAlongTheScenesAxes) {
    HandPlan plan;
    plan.kind = HandKind::keyboard;
    Workspace mapping;
    mapping.pose.rotation = glm::angleAxis(glm::radians(90.0), Vec3(0, 0, 1));
    SceneHand hand(plan, mapping);
    SteeringSettings steering;
    steering.speed = 0.1;
    hand.steer({0, 1, 0}, steering, 1.0, mapping, 0);
    expect_at(hand, {0.1, 0, 0});
}

TEST(StateOfHand, SaysWhatTheDriverSaysFirst) {
    DeviceState state;
    state.connected = true;
    EXPECT_EQ(state_of_hand(state, true, "plug it in"), "plug it in");
    EXPECT_EQ(state_of_hand(state, false, ""), "connected");
    EXPECT_EQ(state_of_hand({}, true, ""), "waiting for the device");
    EXPECT_EQ(state_of_hand({}, false, ""), "waiting for the first tick");
}

TEST(StateOfHand, SaysWhyThereIsNoForceAndWhatIsTooStiff) {
    DeviceState state;
    state.connected = true;
    state.safety = HandState::ramping;
    state.stiffness_wanted = 800.0;
    state.stiffness_used = 210.0;
    const std::string text = state_of_hand(state, false, "");
    EXPECT_EQ(text.rfind("connected; ", 0), 0u);
    EXPECT_NE(text.find(text_of(state.safety)), std::string::npos);
    EXPECT_NE(text.find("210"), std::string::npos) << text;
}

TEST(StateOfFingertip, SaysWhatItDoesOrWhyItIsNotFelt) {
    ProxyState state;
    EXPECT_EQ(state_of_fingertip(state), "waiting for the first tick");
    state.handle = 1;
    EXPECT_EQ(state_of_fingertip(state), "free");
    state.status = proxy_touching;
    EXPECT_EQ(state_of_fingertip(state), "touching");
    state.status |= proxy_letting_out;
    EXPECT_NE(state_of_fingertip(state).find("not felt until"), std::string::npos);
    state.status |= proxy_absent;
    EXPECT_NE(state_of_fingertip(state).find("began inside"), std::string::npos);
}

TEST(StateOfTool, SaysWhatItDoesOrWhyItIsNotFelt) {
    ToolState state;
    EXPECT_EQ(state_of_tool(state), "waiting for the first tick");
    state.handle = 1;
    EXPECT_EQ(state_of_tool(state), "free");
    state.status = tool_touching;
    EXPECT_EQ(state_of_tool(state), "touching");
    state.status |= tool_turn_fixed;
    EXPECT_EQ(state_of_tool(state), "touching; its robot cannot turn it");
    state.status |= tool_wrist_loose;
    EXPECT_NE(state_of_tool(state).find("use one that gives a torque"), std::string::npos);
    state.status |= tool_absent;
    EXPECT_NE(state_of_tool(state).find("does not fit"), std::string::npos);
}

TEST(UsualRadius, IsKnownBeforeTheDeviceIsThere) {
    SteeringSettings steering;
    steering.reach = 0.3;
    EXPECT_EQ(usual_radius(HandKind::keyboard, steering), 0.3);
    EXPECT_EQ(usual_radius(HandKind::mouse, steering), 0.0);
    EXPECT_EQ(usual_radius(HandKind::path, steering), 0.0);
    EXPECT_GT(usual_radius(HandKind::falcon, steering), 0.01);
    EXPECT_GT(usual_radius(HandKind::inverse3, steering), 0.01);
    EXPECT_EQ(usual_radius(HandKind::emulated_robot, steering), usual_radius(HandKind::falcon, steering));
    EXPECT_EQ(usual_radius(HandKind::openhaptics, steering), 0.0) << "the device itself says it";
}

TEST(ProblemOfGamepad, NamesThoseThatAreThere) {
    EXPECT_NE(problem_of_gamepad(0, {}).find("plug one in"), std::string::npos);
    EXPECT_EQ(problem_of_gamepad(2, {{0, "One"}, {2, "Other"}}), "");
    EXPECT_EQ(problem_of_gamepad(1, {{0, "One"}, {2, "Other"}}),
              "there is no gamepad 1: set 'gamepad' to one of 0 (One), 2 (Other)");
}

}  // namespace
}  // namespace tactus::scene_hand_test
