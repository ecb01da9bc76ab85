#include "devices/emulated_robot.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tactus::emulated_robot_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;

// Nothing, or a floor below the tip.
struct Floor final : RobotSurroundings {
    double height = -1.0;
    Vec3 push(Nanoseconds, const Vec3& tip, const Vec3&) override {
        return {0.0, std::max(0.0, 1'000.0 * (height - tip.y)), 0.0};
    }
};

struct Rig {
    std::shared_ptr<Floor> floor = std::make_shared<Floor>();
    EmulatedRobot robot;
    DeviceSample sample;
    Nanoseconds now = 0;

    explicit Rig(const EmulatedRobotSettings& settings = {}) : robot(settings, floor) {
        sample = robot.read(0);
    }

    // Held at `target` by a spring and a damper.
    void hold(const Vec3& target, int ticks) {
        for (int i = 0; i < ticks; ++i) {
            robot.write(now, 800.0 * (target - sample.position) - 4.0 * sample.velocity);
            now += ms;
            sample = robot.read(now);
        }
    }
};

TEST(EmulatedRobot, GoesWhereItIsDriven) {
    Rig rig;
    EXPECT_LT(glm::length(rig.robot.tip()), 1e-9);
    rig.hold({0.02, 0.01, -0.01}, 500);
    EXPECT_LT(glm::distance(rig.robot.tip(), Vec3(0.02, 0.01, -0.01)), 1e-3);
    EXPECT_LT(glm::distance(rig.sample.position, rig.robot.tip()), 5e-4);
    EXPECT_TRUE(rig.sample.connected);
}

TEST(EmulatedRobot, RestsOnWhatItRunsInto) {
    Rig rig;
    rig.floor->height = -0.01;
    rig.hold({0.0, -0.02, 0.0}, 1'000);
    // Two springs share the 10 mm: 800 N/m of the drive and 1000 N/m of the floor.
    EXPECT_NEAR(rig.robot.tip().y, -0.01 - 0.01 * 800.0 / 1'800.0, 5e-4);
    EXPECT_NEAR(rig.robot.contact().y, 1'000.0 * 0.01 * 800.0 / 1'800.0, 0.4);
}

// The controller is told of another robot than the one that moves.
TEST(EmulatedRobot, MovesAsItIsWhateverItsControllerBelieves) {
    EmulatedRobotSettings mistaken;
    mistaken.believed_mass = 1.3;
    mistaken.believed_friction = 0.7;
    Rig rig(mistaken), known;
    for (Rig* one : {&rig, &known}) {
        one->hold({0.02, 0.01, 0.0}, 300);
    }
    EXPECT_EQ(rig.robot.tip(), known.robot.tip());
    const DeviceCapabilities told = rig.robot.capabilities(), is = known.robot.capabilities();
    EXPECT_DOUBLE_EQ(told.mass, 1.3 * is.mass);
    EXPECT_DOUBLE_EQ(told.viscous, 0.7 * is.viscous);
    EXPECT_DOUBLE_EQ(told.coulomb, 0.7 * is.coulomb);
}

TEST(EmulatedRobot, ItsGearsHideTheFirstOfATurnBack) {
    EmulatedRobotSettings loose;
    loose.backlash = 0.01;
    Rig rig(loose), tight;
    for (Rig* one : {&rig, &tight}) {
        one->hold({0.02, 0.0, 0.0}, 500);
        one->hold({0.0, 0.0, 0.0}, 500);
    }
    EXPECT_GT(glm::distance(rig.sample.position, rig.robot.tip()),
              glm::distance(tight.sample.position, tight.robot.tip()) + 1e-4);
}

TEST(EmulatedRobot, StaysWithinItsStopsWhateverItIsDrivenWith) {
    Rig rig;
    rig.hold({1.0, 1.0, 1.0}, 2'000);
    EXPECT_LT(glm::length(rig.robot.tip()), 0.15);
    EXPECT_TRUE(rig.sample.connected);
}

}  // namespace
}  // namespace tactus::emulated_robot_test
