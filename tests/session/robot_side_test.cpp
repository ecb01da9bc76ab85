#include "session/robot_side.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tactus
