#include "session/robot_side.hpp"

#include <gtest/gtest.h>

#include "model_rig.hpp"
#include "shared/robot_at_block.hpp"
#include "shared/teleop_run.hpp"

namespace tactus {
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

// Two seconds of touch: half of them it rubs, half of them it pushes.
TEST(RobotSide, LearnsHowStiffHowRoughAndHowHeavyWhatItTouchesIs) {
    unsigned seed = 1;
    for (const shared::BlockTruth& truth : {shared::BlockTruth{300.0, 0.3, 0.3, 0.5, 1},
                                            {800.0, 0.6, 0.4, 0.8, 2},
                                            {1200.0, 0.5, 0.5, 0.25, 3}}) {
        shared::RobotAtBlock robot(truth);
        robot.rub(1.0);
        robot.push(1.0);
        ASSERT_GT(robot.block().x, 0.02) << "it has not been pushed";
        const ObjectEstimate& told = robot.told();
        EXPECT_TRUE(told.stiffness.known && told.friction.known && told.mass.known) << seed;
        EXPECT_NEAR(told.stiffness.value, truth.stiffness, 0.1 * truth.stiffness);
        EXPECT_NEAR(told.friction.value, truth.friction, 0.1 * truth.friction);
        EXPECT_NEAR(told.mass.value, truth.mass, 0.1 * truth.mass);
        ++seed;
    }
}

}  // namespace
}  // namespace tactus
