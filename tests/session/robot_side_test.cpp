#include "session/robot_side.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model_rig.hpp"
#include "shared/robot_at_block.hpp"
#include "shared/teleop_run.hpp"

namespace tactus::robot_side_test {
namespace {

using shared::TeleopCase;
using shared::TeleopFigures;
using shared::TeleopScene;

// A floor at y = 0 and a hand that goes through it twice.
TeleopScene scene() {
    shared::TeleopBody floor;
    floor.name = "Floor";
    floor.addition.description.shapes = {{BoxShape{Vec3(0.5, 0.05, 0.5)}, Pose{}}};
    floor.addition.description.pose.position = {0.0, -0.05, 0.0};
    floor.addition.description.motion = Motion::Static;
    floor.addition.touch_material.stiffness = 500.0;
    TeleopScene scene;
    scene.bodies = {floor};
    scene.force_limit = 8.0;
    scene.radius = 0.005;
    CircleWave way;
    way.centre = {0.0, 0.008, 0.0};
    way.radius = 0.02;
    way.amplitude = 0.014;
    way.turn_time = 4'000'000'000;
    way.waves = 2;
    scene.path = way;
    return scene;
}

TeleopCase robot_case(double delay) {
    TeleopCase one;
    one.robot = one.uses_arm = true;
    one.settings.traditional = one.settings.robot = true;
    one.forth.delay = one.back.delay = from_seconds(0.5 * delay);
    one.seconds = 4.0;
    return one;
}

TEST(RobotSide, TheRobotFollowsTheHandAndWhatItRunsIntoIsFelt) {
    TeleopFigures figures = run_teleop(scene(), robot_case(0.0));
    EXPECT_LT(figures["hand_position_error_rms_mm"], 6.0);
    EXPECT_GT(figures["hand_position_error_rms_mm"], 0.0);
    EXPECT_LT(figures["force_error_mean_N"], 1.5);
    EXPECT_GT(figures["penetration_max_mm"], 0.5);
}

TEST(RobotSide, TwoRunsAreTheSameToTheBit) {
    EXPECT_EQ(run_teleop(scene(), robot_case(0.05)), run_teleop(scene(), robot_case(0.05)));
}

// The robot's friction, and what its observer does not see, take part: both ports make no energy all the
// same.
TEST(RobotSide, WavesMakeNoEnergyThroughARobot) {
    for (const double delay : {0.0, 0.02, 0.05, 0.1, 0.2}) {
        TeleopCase one = robot_case(delay);
        one.settings.passivity = Passivity::wave_variables;
        TeleopFigures figures = run_teleop(scene(), one);
        EXPECT_LT(figures["link_energy_created_J"], 1e-4) << delay;
        // Until the operator's end has heard an answer it sends no waves, and the robot comes by its drift.
        EXPECT_LT(figures["hand_position_error_rms_mm"], 6.5 + 15.0 * delay) << delay << ": it follows";
    }
}

// A robot is not where its target is: the spring between has energy, and so has the robot that moves.
TEST(RobotSide, NoSchemeMakesMoreEnergyThanItsStoresThroughARobot) {
    for (const Passivity scheme :
         {Passivity::wave_variables, Passivity::time_domain, Passivity::two_layers}) {
        for (const double delay : {0.0, 0.01, 0.05, 0.2, 0.5}) {
            TeleopScene pressed = scene();
            pressed.path = KeyframePath{
                {{0, {0.0, 0.05, 0.0}}, {200'000'000, {0.0, 0.05, 0.0}}, {600'000'000, {0.0, -0.02, 0.0}}},
                PathInterpolation::linear,
                false};
            TeleopCase one = robot_case(delay);
            one.settings.passivity = scheme;
            const PassivitySettings& passive = one.settings.passive;
            const double store = scheme == Passivity::wave_variables ? 1e-4
                                 : scheme == Passivity::time_domain
                                     ? passive.reserve + passive.far_store
                                     : passive.reserve + passive.far_store + passive.tank;
            TeleopFigures figures = run_teleop(pressed, one);
            EXPECT_LE(figures["link_energy_created_J"], store) << static_cast<int>(scheme) << " " << delay;
        }
    }
}

// A box that the robot pushes back and forth with its side.
TeleopScene box_scene() {
    TeleopScene made = scene();
    made.bodies[0].addition.description.pose.position.y = -0.07;
    shared::TeleopBody box;
    box.name = "Box";
    box.addition.description.shapes = {{BoxShape{Vec3(0.012)}, Pose{}}};
    box.addition.description.pose.position = {0.0, -0.008, 0.0};
    box.addition.description.motion = Motion::Dynamic;
    box.addition.description.mass = 0.3;
    box.addition.description.material.friction = 0.4;
    box.addition.touch_material.stiffness = 500.0;
    made.bodies.push_back(box);
    made.path = KeyframePath{{{0, {-0.03, -0.008, 0.0}},
                              {500'000'000, {-0.03, -0.008, 0.0}},
                              {1'500'000'000, {0.012, -0.008, 0.0}},
                              {2'000'000'000, {0.012, -0.008, 0.0}},
                              {3'000'000'000, {-0.03, -0.008, 0.0}}},
                             PathInterpolation::linear,
                             false};
    return made;
}

// With small stores and with large ones (those of docs/teleoperation.md that are tuned).
TEST(RobotSide, NoSchemeMakesMoreEnergyThanItsStoresAtABox) {
    LinkConditions clean, bad;
    bad.jitter = 5'000'000;
    bad.burst = bursts(0.2, 20);
    double pushed = 0.0;
    for (const Passivity scheme :
         {Passivity::wave_variables, Passivity::time_domain, Passivity::two_layers}) {
        for (const bool is_large : {false, true}) {
            for (const LinkConditions& line : {clean, bad}) {
                for (const double delay : {0.0, 0.05, 0.2, 0.5}) {
                    TeleopCase one = robot_case(delay);
                    one.settings.passivity = scheme;
                    PassivitySettings& passive = one.settings.passive;
                    if (is_large) {
                        passive.reserve = 0.0078;
                        passive.far_store = 0.0923;
                        passive.tank = 0.047;
                        passive.drift_rate = 1.09;
                    }
                    for (LinkConditions* const way : {&one.forth, &one.back}) {
                        const Nanoseconds keeps = way->delay;
                        *way = line;
                        way->delay = keeps;
                    }
                    const double store = scheme == Passivity::wave_variables ? 1e-4
                                         : scheme == Passivity::time_domain
                                             ? passive.reserve + passive.far_store
                                             : passive.reserve + passive.far_store + passive.tank;
                    TeleopFigures figures = run_teleop(box_scene(), one);
                    EXPECT_LE(figures["link_energy_created_J"], store)
                        << static_cast<int>(scheme) << (is_large ? " large " : " small ") << delay;
                    pushed = std::max(pushed, std::abs(figures["energy_at_far_side_J"]));
                }
            }
        }
    }
    EXPECT_GT(pushed, 5e-3) << "the box is pushed";
}

// Scenario 5: what a camera has found at the far side makes the operator's model, and follows what the camera
// sees, though nothing is simulated there.
TEST(RobotSide, TellsWhatIsKnownOfItsPlace) {
    TeleopSettings settings;
    settings.robot = true;
    EXPECT_EQ(scenario_of(settings), 5);
    session_test::ModelRig rig({}, settings);
    rig.far->add("floor", session_test::ground());
    const SessionHandle body =
        rig.far->add("found", session_test::body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic));
    rig.run(from_seconds(1.0));
    ASSERT_NE(rig.near->find("found"), nullptr);
    EXPECT_NEAR(glm::distance(rig.near->pose("found").position, Vec3(0.0, 0.05, 0.0)), 0.0, 1e-4);
    rig.far->session.teleport_body(body, {{0.02, 0.05, 0.01}});
    rig.run(from_seconds(1.0));
    EXPECT_NEAR(glm::distance(rig.near->pose("found").position, Vec3(0.02, 0.05, 0.01)), 0.0, 1e-3);
    // The hand feels the model, not what comes from far away.
    EXPECT_EQ(rig.near->port->statistics.front().link.peer_hello.scenario, 5);
}

// Two seconds of touch: half of them it presses and rubs, half of them it pushes. What drags along under the
// rubbing tip tells little of its friction, and what is light little of its mass.
TEST(RobotSide, LearnsHowStiffHowRoughAndHowHeavyWhatItTouchesIs) {
    constexpr int blocks = 16;
    int rough = 0, heavy = 0;
    for (unsigned seed = 1; seed <= blocks; ++seed) {
        const shared::BlockTruth truth = shared::any_block(seed);
        shared::RobotAtBlock robot(truth);
        robot.rub(1.0);
        robot.push(1.0);
        ASSERT_GT(robot.block().x, 0.02) << "it has not been pushed";
        const ObjectEstimate& told = robot.told();
        const auto is_right = [](const TouchValue& value, double is) {
            return value.known && std::abs(value.value - is) <= 0.1 * is;
        };
        EXPECT_TRUE(is_right(told.stiffness, truth.stiffness)) << seed << ": " << told.stiffness.value;
        rough += is_right(told.friction, truth.friction);
        heavy += is_right(told.mass, truth.mass);
    }
    EXPECT_GE(rough, blocks * 3 / 4);
    EXPECT_GE(heavy, blocks * 3 / 4);
}

}  // namespace
}  // namespace tactus::robot_side_test
