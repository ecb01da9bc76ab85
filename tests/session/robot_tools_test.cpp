// A robot that carries a tool over a link, scenarios 3 and 5: what the operator's hand does with it.
#include <algorithm>
#include <cmath>
#include <deque>
#include <glm/gtc/quaternion.hpp>

#include "linked_tools.hpp"
#include "recorded_inputs.hpp"
#include "session/robot_side.hpp"
#include "shared/played_robot.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::robot_tools_test {
namespace {

using namespace session_test;
using shared::PlayedRobot;
using shared::PlayedRobotSettings;
using Wrist = PlayedRobotSettings::Wrist;

TeleopSettings scenario(int number) {
    TeleopSettings settings;
    settings.robot = true;
    settings.traditional = number == 3;
    return settings;
}

PlayedRobotSettings with_wrist(Wrist wrist) {
    PlayedRobotSettings settings;
    settings.wrist = wrist;
    return settings;
}

Quat turned(double angle, const Vec3& axis) {
    return glm::angleAxis(angle, glm::normalize(axis));
}

// An operator's world with a hand, and a far side whose device is a robot; both hold the bar, or fingertips.
class RobotPlaces : public EmulatedLink {
public:
    struct Choice {
        int scenario = 5;
        PlayedRobotSettings robot;
        double delay = 0.04;     // there and back (unit: seconds)
        bool fingertip = false;  // in place of the tool
        Pose mount, grasp;       // of the tool: on the robot, in the operator's hand
        InputRecorder *near_inputs = nullptr, *far_inputs = nullptr;
    };

    explicit RobotPlaces(const Choice& choice)
        : EmulatedLink(choice.delay),
          settings_(scenario(choice.scenario)),
          robot(choice.robot, choice.fingertip ? nullptr : bar(), choice.mount),
          near(LinkedPlaces::session_settings(), choice.near_inputs),
          far(LinkedPlaces::session_settings(), choice.far_inputs) {
        near.attach({{{SidePlan::Kind::operator_side, settings_, end_of(Side::operator_side, 1), {}, {}},
                      &at_near_,
                      near_port}});
        far.attach({{{SidePlan::Kind::robot, settings_, end_of(Side::teleoperator_side, 2), {}, {}},
                     &at_far_,
                     far_port}});
        let_turn(hand);
        Workspace workspace;
        workspace.force_limit = 100.0;
        const SessionHandle here = near.add_device(hand, workspace).handle;
        const SessionHandle there = far.add_device(robot, workspace).handle;
        if (choice.fingertip) {
            ProxyDescription pointer;
            pointer.device = here;
            near.add_proxy(pointer);
            pointer.device = there;
            far.add_proxy(pointer);
            return;
        }
        for (const auto& [session, device, grasp] :
             {std::tuple(&near, here, choice.grasp), std::tuple(&far, there, choice.mount)}) {
            ToolUse use = held_by(device);
            use.grasp = grasp;
            EXPECT_EQ(session->add_tool(bar(), use).error, "");
        }
    }

    void tick() {
        now += period;
        near.tick(now);
        far.tick(now);
        keep_up();
        near_port->statistics.refresh();
        far_port->statistics.refresh();
    }
    // The owner's part.
    void keep_up() {
        for (Session* const session : {&near, &far, &robot.place}) {
            session->refresh();
            session->collect();
        }
    }
    void ticks(int count) {
        for (int i = 0; i < count; ++i) {
            tick();
        }
    }
    const ToolState& ours() const { return near.snapshot().tools[0]; }
    const ToolState& theirs() const { return far.snapshot().tools[0]; }

private:
    EndpointSettings end_of(Side side, std::uint64_t epoch) const {
        EndpointSettings end = endpoint(side, epoch);
        end.scenario = scenario_of(settings_);
        return end;
    }

    TeleopSettings settings_;

public:
    HeldDevice hand;
    PlayedRobot robot;
    std::shared_ptr<TeleopPort> near_port = std::make_shared<TeleopPort>(),
                                far_port = std::make_shared<TeleopPort>();
    Session near, far;
    Nanoseconds now = 0;
};

// Round in free space, turning.
void circle(HeldDevice& hand, int tick) {
    const double t = 1e-3 * tick;
    const double in = std::min(1.0, t);
    put(hand, in * Vec3(0.05 * std::sin(3.0 * t), 0.03 * std::sin(2.0 * t), 0.05 * std::cos(3.0 * t)),
        turned(in * 0.4 * std::sin(2.5 * t), {0.3, 1.0, 0.2}));
}

struct Followed {
    double place = 0.0;  // RMS of the handle's way to where the hand was one way ago (unit: meters)
    double turn = 0.0;   // likewise (unit: radians)
};

Followed follow(Wrist wrist, bool fingertip) {
    RobotPlaces::Choice choice;
    choice.robot = with_wrist(wrist);
    choice.fingertip = fingertip;
    RobotPlaces places(choice);
    std::deque<Pose> way;
    Followed sum;
    int count = 0;
    for (int i = 0; i < 4'000; ++i) {
        circle(places.hand, i);
        places.tick();
        way.push_back({places.hand.position, places.hand.rotation});
        if (way.size() > 20) {
            way.pop_front();
        }
        if (i >= 1'500) {
            const Vec3 off = places.robot.position - way.front().position;
            const double turn = angle_between(places.robot.rotation, way.front().rotation);
            sum.place += glm::dot(off, off);
            sum.turn += turn * turn;
            ++count;
        }
    }
    return {std::sqrt(sum.place / count), std::sqrt(sum.turn / count)};
}

TEST(RobotTools, ARobotFollowsAToolAsItFollowsAFingertip) {
    const Followed fingertip = follow(Wrist::stiff, true);
    const Followed stiff = follow(Wrist::stiff, false);
    const Followed driven = follow(Wrist::driven, false);
    EXPECT_LT(fingertip.place, 4e-3);
    EXPECT_LT(stiff.place, 1.05 * fingertip.place);
    EXPECT_LT(driven.place, 1.05 * fingertip.place);
    EXPECT_LT(driven.turn, 0.03);
    EXPECT_GT(stiff.turn, 0.1);
}

void add_floor(Session& session, double y, double stiffness = 1000.0) {
    BodyAddition floor = body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, y - 0.1, 0.0}, Motion::Static);
    floor.touch_material = {stiffness, 0.0, 0.0, 0.0};
    ASSERT_EQ(session.add_body(floor).error, "");
    session.settle();
}

// The bar is pressed onto a floor 30 mm below, turned and off its middle.
void press(HeldDevice& hand, int tick, double depth) {
    const double down = std::min(1.0, 1e-3 * tick);
    put(hand, {0.02, -(0.02 + depth) * down, 0.0}, turned(0.06 * down, {0.0, 0.0, 1.0}),
        {0.0, tick < 1'000 ? -(0.02 + depth) : 0.0, 0.0});
}

void press_for(RobotPlaces& places, int ticks, double depth) {
    for (int i = 0; i < ticks; ++i) {
        press(places.hand, i, depth);
        places.tick();
    }
}

// Scenario 3: both force and torque are what the place gives the robot.
TEST(RobotTools, WhatItRunsIntoIsFeltOneDelayLater) {
    RobotPlaces::Choice choice;
    choice.scenario = 3;
    RobotPlaces places(choice);
    add_floor(places.robot.place, -0.03);
    press_for(places, 2'500, 0.006);
    EXPECT_GT(places.robot.pushed().y, 1.0);
    EXPECT_LT(glm::distance(places.ours().force, places.robot.pushed()), 0.2);
    EXPECT_LT(glm::distance(places.hand.force, places.robot.pushed()), 0.2);
    // About the operator's hand, which is where the robot's handle would be.
    EXPECT_GT(glm::length(places.robot.twisted()), 0.02);
    EXPECT_LT(glm::distance(places.hand.torque, places.robot.twisted()), 0.01);
    places.lose_everything(true);
    places.ticks(1'500);
    EXPECT_EQ(places.robot.force, Vec3(0.0));
    EXPECT_EQ(places.robot.torque, Vec3(0.0));
    EXPECT_EQ(places.hand.force, Vec3(0.0));
    EXPECT_EQ(places.hand.torque, Vec3(0.0));
}

// Scenario 5: the hand is answered by the model at once, and the robot presses as hard.
TEST(RobotTools, AModelIsFeltAtOnceAndTheRobotPressesLikewise) {
    RobotPlaces places({});
    add_floor(places.near, -0.03);
    add_floor(places.robot.place, -0.03);
    press_for(places, 1'500, 0.006);
    EXPECT_GT(places.ours().force.y, 4.0);
    EXPECT_LT(places.ours().pose.position.y, -0.01);
    EXPECT_GT(places.robot.pushed().y, 2.0);
    EXPECT_LT(glm::distance(places.robot.tool().pose.position, places.ours().pose.position), 3e-3);
    EXPECT_LT(angle_between(places.robot.tool().pose.rotation, places.ours().pose.rotation), 0.03);
    EXPECT_EQ(places.ours().status & tool_turn_fixed, 0u);
    EXPECT_EQ(places.theirs().status & tool_turn_fixed, 0u);
    // The model's tool is where the model has it, not where the robot lags.
    EXPECT_EQ(places.near_port->statistics.front().corrections, 0u);
}

// The hand goes a third of a metre through a wall that only the robot has, and turns wildly.
TEST(RobotTools, AWallThatTheModelDoesNotKnowStopsItWithinItsLimits) {
    for (const Wrist wrist : {Wrist::driven, Wrist::stiff}) {
        RobotPlaces::Choice choice;
        choice.robot = with_wrist(wrist);
        choice.robot.radius = 1.0;
        RobotPlaces places(choice);
        places.robot.place.add_body(body(BoxShape{{0.02, 0.5, 0.5}}, {0.17, 0.0, 0.0}, Motion::Static));
        places.robot.place.settle();
        put(places.hand, Vec3(0.0), Quat(1.0, 0.0, 0.0, 0.0));
        places.ticks(100);
        double strongest = 0.0, most_torque = 0.0, steepest = 0.0;
        Vec3 before = places.robot.force;
        for (int i = 0; i < 3'000; ++i) {
            const double t = 1e-3 * i;
            put(places.hand, {0.35 * std::sin(2.0 * t), 0.0, 0.05 * std::sin(3.0 * t)},
                turned(1.2 * std::sin(5.0 * t), {0.0, 0.3, 1.0}));
            places.tick();
            ASSERT_EQ(places.robot.tool().status & tool_absent, 0u) << i;
            for (const ToolSphere& sphere : bar()->spheres) {
                const Vec3 center = to_parent(places.robot.tool().pose, sphere.center);
                ASSERT_LT(center.x + sphere.radius, 0.15 + 1e-6) << i;
            }
            strongest = std::max(strongest, glm::length(places.robot.force));
            most_torque = std::max(most_torque, glm::length(places.robot.torque));
            // A force that ends, ends at once; what grows does so gradually.
            if (glm::length(places.robot.force) > glm::length(before)) {
                steepest = std::max(steepest, glm::distance(places.robot.force, before));
            }
            before = places.robot.force;
        }
        EXPECT_GT(strongest, 7.0);
        EXPECT_LE(strongest, 8.0 * (1.0 + 1e-9));
        EXPECT_LE(most_torque, 0.5 * (1.0 + 1e-9));
        EXPECT_LE(steepest, 4.0 * (1.0 + 1e-9));
        EXPECT_EQ(places.hand.force, Vec3(0.0)) << "the model knows of no wall";
    }
}

// However the hand and the two mounts are turned, the tool is as it is mounted on the robot, here and there.
TEST(RobotTools, ARobotThatCannotTurnHoldsTheToolOnBothSides) {
    for (const int number : {3, 5}) {
        RobotPlaces::Choice choice;
        choice.scenario = number;
        choice.robot = with_wrist(Wrist::stiff);
        choice.mount = {{0.01, -0.02, 0.0}, rotation_as_sent(turned(0.3, {0.0, 1.0, 0.0}))};
        choice.grasp = {{0.0, -0.03, 0.01}, turned(-0.2, {1.0, 0.0, 0.0})};
        RobotPlaces places(choice);
        put(places.hand, Vec3(0.0), turned(0.5, {0.3, 1.0, 0.5}));
        places.ticks(400);
        EXPECT_TRUE(places.ours().status & tool_turn_fixed);
        EXPECT_TRUE(places.theirs().status & tool_turn_fixed);
        Vec3 before(0.0);
        for (int i = 0; i < 2'000; ++i) {
            const double t = 1e-3 * i;
            put(places.hand, 0.02 * Vec3(std::sin(2.0 * t), std::sin(3.0 * t), 0.0),
                turned(0.5 + std::sin(2.0 * t), {0.3, 1.0, 0.5}));
            places.tick();
            ASSERT_LT(angle_between(places.ours().pose.rotation, choice.mount.rotation), 1e-6) << i;
            ASSERT_LT(angle_between(places.theirs().pose.rotation, choice.mount.rotation), 1e-6) << i;
            before = places.hand.position;
        }
        // Both at rest: what the hand does by turning alone moves neither.
        put(places.hand, before, turned(-0.4, {1.0, 0.2, 0.0}));
        places.ticks(1'000);
        const Vec3 ours = places.ours().pose.position;
        EXPECT_LT(glm::distance(ours, places.theirs().pose.position), 1e-3);
        put(places.hand, before, turned(0.7, {0.0, 0.0, 1.0}));
        places.ticks(1'000);
        EXPECT_LT(
            glm::distance(places.ours().pose.position, number == 5 ? ours : places.theirs().pose.position),
            1e-6);
        EXPECT_EQ(places.robot.torque, Vec3(0.0));
    }
}

// Pressed beside its middle onto a floor: a model's tool that gave way by turning would press less, and a
// hand that was given the torque would be turned by it for nothing.
TEST(RobotTools, AToolThatCannotTurnIsHeldFirmlyAndGivesNoTorque) {
    RobotPlaces::Choice choice;
    choice.robot = with_wrist(Wrist::stiff);
    RobotPlaces places(choice);
    BodyAddition step = body(BoxShape{{0.02, 0.1, 0.5}}, {0.09, -0.13, 0.0}, Motion::Static);
    step.touch_material = {1000.0, 0.0, 0.0, 0.0};
    for (Session* const session : {&places.near, &places.robot.place}) {
        session->add_body(step);
        session->settle();
    }
    put(places.hand, Vec3(0.0), Quat(1.0, 0.0, 0.0, 0.0));
    places.ticks(300);
    for (int i = 0; i < 1'000; ++i) {
        put(places.hand, {0.0, -0.024 * std::min(1.0, 2e-3 * i), 0.0},
            turned(0.1 * std::sin(0.01 * i), {0.0, 0.0, 1.0}));
        places.tick();
    }
    // 4 mm at 1000 N/m.
    EXPECT_NEAR(places.ours().force.y, 4.0, 0.02);
    EXPECT_LT(angle_between(places.ours().pose.rotation, Quat(1.0, 0.0, 0.0, 0.0)), 1e-3);
    EXPECT_EQ(places.hand.torque, Vec3(0.0));
}

// That the tool does not turn is heard while it is pressed: no hand feels a step.
TEST(RobotTools, HearingThatItCannotTurnKicksNoHand) {
    RobotPlaces::Choice choice;
    choice.robot = with_wrist(Wrist::stiff);
    choice.delay = 0.4;
    RobotPlaces places(choice);
    add_floor(places.near, -0.03);
    double step = 0.0;
    Vec3 before(0.0);
    bool was_fixed = false;
    for (int i = 0; i < 2'500; ++i) {
        const double down = std::min(1.0, 1e-2 * i);
        put(places.hand, {0.0, -0.028 * down, 0.0}, turned(0.03 * down, {0.0, 0.0, 1.0}));
        places.tick();
        if (i > 150) {
            step = std::max(step, glm::distance(places.hand.force, before));
        } else {
            EXPECT_EQ(places.ours().status & tool_turn_fixed, 0u);
        }
        before = places.hand.force;
        was_fixed = was_fixed || (places.ours().status & tool_turn_fixed) != 0;
    }
    EXPECT_TRUE(was_fixed);
    EXPECT_GT(before.y, 5.0);
    EXPECT_LT(step, 0.1);
}

TEST(RobotTools, AWristThatNothingHoldsIsLeftAlone) {
    RobotPlaces::Choice choice;
    choice.robot = with_wrist(Wrist::loose);
    RobotPlaces places(choice);
    for (int i = 0; i < 1'000; ++i) {
        circle(places.hand, i);
        places.tick();
        ASSERT_EQ(places.robot.force, Vec3(0.0));
        ASSERT_EQ(places.robot.torque, Vec3(0.0));
    }
    EXPECT_TRUE(places.theirs().status & tool_wrist_loose);
    EXPECT_FALSE(places.ours().status & tool_turn_fixed);
}

// It is led no faster than 1 m/s, whatever comes, which its spring overshoots by less than as much again; and
// it follows again when packets do.
TEST(RobotTools, LostPacketsNeitherThrowItNorLeaveItBehind) {
    RobotPlaces places({});
    LinkConditions bad;
    bad.delay = from_seconds(0.03);
    bad.jitter = from_seconds(0.02);
    bad.burst = bursts(0.4, 20.0);
    places.change(bad);
    double fastest = 0.0, farthest = 0.0;
    for (int i = 0; i < 6'000; ++i) {
        circle(places.hand, i);
        if (i == 2'000 || i == 3'500) {
            places.lose_everything(i == 2'000);
        }
        if (i == 3'500) {
            places.change(bad);
        }
        places.tick();
        fastest = std::max(fastest, glm::length(places.robot.velocity));
        if (i == 3'400) {
            EXPECT_EQ(places.robot.force, Vec3(0.0)) << "nobody is heard";
        }
        if (i > 4'500 || (i > 1'000 && i < 2'000)) {
            farthest = std::max(farthest, glm::distance(places.robot.position, places.hand.position));
        }
    }
    EXPECT_LT(fastest, 2.0);
    // The hand goes up to 0.2 m/s, and is heard up to a quarter of a second later.
    EXPECT_LT(farthest, 0.05);
}

// Scenario 3: its power is cut while it presses, and comes back.
TEST(RobotTools, ARobotWithoutPowerIsLetGoAndComesBackGently) {
    RobotPlaces::Choice choice;
    choice.scenario = 3;
    RobotPlaces places(choice);
    add_floor(places.robot.place, -0.03);
    press_for(places, 1'500, 0.006);
    EXPECT_GT(places.hand.force.y, 1.0);
    places.robot.powered = false;
    double step = 0.0;
    Vec3 felt = places.hand.force;
    for (int i = 0; i < 1'000; ++i) {
        places.tick();
        ASSERT_EQ(places.robot.force, Vec3(0.0));
        ASSERT_EQ(places.robot.torque, Vec3(0.0));
        step = std::max(step, glm::distance(places.hand.force, felt));
        felt = places.hand.force;
    }
    EXPECT_EQ(felt, Vec3(0.0));
    EXPECT_LT(step, 0.5);
    // It was pushed out meanwhile; the hand is where it was.
    places.robot.position = {-0.05, 0.06, 0.0};
    places.robot.velocity = Vec3(0.0);
    places.robot.powered = true;
    double fastest = 0.0;
    for (int i = 0; i < 2'000; ++i) {
        places.tick();
        fastest = std::max(fastest, glm::length(places.robot.velocity));
    }
    EXPECT_LT(fastest, 2.0);
    EXPECT_GT(places.hand.force.y, 1.0);
}

// What the camera sees goes into the model under the tool, though the robot is somewhere else by its lag.
TEST(RobotTools, WhatIsSeenCorrectsTheModelAndLeavesTheToolOutside) {
    RobotPlaces places({});
    add_floor(places.near, -0.05);
    BodyAddition seen = body(BoxShape{Vec3(0.03)}, {0.15, -0.02, 0.0}, Motion::Dynamic, 0.3);
    seen.description.material.friction = 0.3;
    BodyAddition believed = seen;
    believed.description.pose.position.x = 0.16;
    const SessionHandle there = places.far.add_body(seen).handle;
    const SessionHandle here = places.near.add_body(believed).handle;
    places.near_port->bindings.try_push({there, here});
    places.near.settle();
    places.far.settle();
    for (int i = 0; i < 1'500; ++i) {
        put(places.hand, {0.025 * std::min(1.0, 2e-3 * i), 0.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
        places.tick();
        if (i % 33 == 0) {
            places.far.see_body(
                there, {{seen.description.pose, Vec3(0.0), Vec3(0.0)}, 0.03, {Mat3(1e-10), Mat3(1e-8)}});
        }
        EXPECT_EQ(places.ours().status & tool_absent, 0u) << i;
    }
    EXPECT_GT(places.near_port->statistics.front().corrections, 0u);
    const Vec3 block = places.near.snapshot().bodies[0].pose.position;
    for (const ToolSphere& sphere : bar()->spheres) {
        const Vec3 center = to_parent(places.ours().pose, sphere.center);
        EXPECT_LT(center.x + sphere.radius, block.x - 0.03 + 1e-4);
    }
}

TEST(RobotTools, ASessionThatWasRecordedReplaysToTheSameBits) {
    for (const Wrist wrist : {Wrist::driven, Wrist::stiff}) {
        RecordedInputs near_inputs(LinkedPlaces::session_settings()),
            far_inputs(LinkedPlaces::session_settings());
        {
            RobotPlaces::Choice choice;
            choice.robot = with_wrist(wrist);
            choice.near_inputs = &near_inputs.recorder;
            choice.far_inputs = &far_inputs.recorder;
            RobotPlaces places(choice);
            add_floor(places.near, -0.03);
            add_floor(places.robot.place, -0.028);
            LinkConditions bad;
            bad.delay = from_seconds(0.02);
            bad.loss = 0.2;
            places.change(bad);
            for (int i = 0; i < 1'500; ++i) {
                press(places.hand, i, 0.006);
                places.tick();
                if (i % 16 == 15) {
                    near_inputs.drain();
                    far_inputs.drain();
                }
            }
        }
        near_inputs.end();
        far_inputs.end();
        for (const RecordedInputs* const inputs : {&near_inputs, &far_inputs}) {
            expect_whole(inputs->play(), 1'500);
        }
    }
}

TEST(RobotTools, ATickAllocatesNothing) {
    for (const int number : {3, 5}) {
        RobotPlaces::Choice choice;
        choice.scenario = number;
        RobotPlaces places(choice);
        add_floor(places.robot.place, -0.03);
        places.ticks(50);
        std::size_t seen = 0;
        for (int i = 0; i < 1'000; ++i) {
            press(places.hand, i, 0.006);
            places.now += period;
            testing::AuditScope audit;
            places.near.tick(places.now);
            places.far.tick(places.now);
            audit.finish();
            seen += audit.allocations() + audit.frees();
            places.keep_up();
        }
        EXPECT_EQ(seen, 0u);
    }
}

}  // namespace
}  // namespace tactus::robot_tools_test
