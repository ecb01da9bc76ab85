#include "session/hand_mapping.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "session_rig.hpp"

namespace tactus::hand_mapping_test {
namespace {

using namespace session_test;

Workspace turned() {
    Workspace workspace;
    workspace.pose = {{1.0, 2.0, 3.0}, glm::angleAxis(0.5 * std::numbers::pi, Vec3(0.0, 0.0, 1.0))};
    workspace.scale = 2.0;
    workspace.force_scale = 0.25;
    return workspace;
}

TEST(HandMapping, ForcesGoThereAndBack) {
    const Vec3 force{1.0, -2.0, 0.5};
    EXPECT_LT(glm::distance(force_in_scene(turned(), force_on_device(turned(), force)), force), 1e-15);
    EXPECT_LT(glm::distance(force_on_device(turned(), {0.0, 4.0, 0.0}), Vec3(1.0, 0.0, 0.0)), 1e-15);
}

// F·dx of the scene, with dx = scale·dx of the device and F of the device = force_scale·F.
TEST(HandMapping, EnergyIsForceTimesWayOnEitherSide) {
    const Workspace workspace = turned();
    const Vec3 force{1.0, 2.0, 3.0};
    const Vec3 way{0.01, 0.02, -0.03};
    EXPECT_NEAR(energy_on_device(workspace, glm::dot(force, velocity_in_scene(workspace, way))),
                glm::dot(force_on_device(workspace, force), way), 1e-15);
}

TEST(HandMapping, BeforeTheEdgeNothingDrifts) {
    Workspace workspace;
    workspace.edge_speed = 0.2;
    EXPECT_EQ(drift_at_edge(workspace, 0.05, {0.04, 0.0, 0.0}), Vec3(0.0));
    EXPECT_EQ(drift_at_edge(workspace, 0.0, {9.0, 0.0, 0.0}), Vec3(0.0)) << "it has no workspace";
    workspace.edge_speed = 0.0;
    EXPECT_EQ(drift_at_edge(workspace, 0.05, {0.05, 0.0, 0.0}), Vec3(0.0));
}

TEST(HandMapping, TheFartherOutTheFasterAndNoFasterThanAsked) {
    Workspace workspace = turned();
    workspace.edge_speed = 0.2;
    EXPECT_LT(glm::distance(drift_at_edge(workspace, 0.08, {0.075, 0.0, 0.0}), {0.0, 0.1, 0.0}), 1e-12);
    EXPECT_LT(glm::distance(drift_at_edge(workspace, 0.08, {0.5, 0.0, 0.0}), {0.0, 0.2, 0.0}), 1e-12);
}

TEST(HandMapping, AHandAtTheEdgeGoesOnAndStaysWhereItCameBackFromThere) {
    SessionRig rig;
    rig.device.can.radius = 0.08;
    Workspace workspace;
    workspace.edge_speed = 0.2;
    rig.session.set_workspace(rig.hand, workspace);
    rig.device.position = {0.08, 0.0, 0.0};
    rig.tick();
    const double start = rig.proxy_state().hand.x;
    rig.ticks(1000);
    EXPECT_NEAR(rig.proxy_state().hand.x - start, 0.2, 1e-9);
    rig.draw({0.0, 0.0, 0.0}, 50);
    const Vec3 middle = rig.proxy_state().hand;
    rig.ticks(100);
    EXPECT_EQ(rig.proxy_state().hand, middle);
    EXPECT_GT(middle.x, 0.2);
}

TEST(HandMapping, AScaledForceIsFeltScaledAndLimitedAtTheDevice) {
    SessionRig rig;
    rig.add(ground());
    Workspace workspace;
    workspace.force_scale = 0.5;
    workspace.force_limit = 2.0;
    rig.session.set_workspace(rig.hand, workspace);
    rig.device.position = {0.0, 0.1, 0.0};
    rig.tick();
    rig.draw({0.0, 0.006, 0.0}, 100);  // 4 mm into the ground: 2 N in the scene
    EXPECT_NEAR(rig.proxy_state().force.y, 2.0, 1e-6);
    EXPECT_NEAR(rig.device.force.y, 1.0, 1e-6);
    rig.draw({0.0, -0.01, 0.0}, 300);  // 10 N
    EXPECT_NEAR(rig.device.force.y, 2.0, 1e-6);
}

// A wall that the device can just render is half as stiff at it where forces are halved, so that twice as
// stiff a one is safe.
TEST(HandMapping, HalfTheForceMakesTwiceTheStiffnessSafe) {
    const auto felt = [](double force_scale) {
        SessionRig rig;
        rig.device.can.feels = true;
        rig.device.can.damping = 1.0;  // 2 b / T = 2000 N/m
        BodyAddition hard = ground();
        hard.touch_material.stiffness = 4000.0;
        rig.add(hard);
        Workspace workspace;
        workspace.force_scale = force_scale;
        workspace.force_limit = 1e6;
        rig.session.set_workspace(rig.hand, workspace);
        rig.device.position = {0.0, 0.1, 0.0};
        rig.tick();
        rig.draw({0.0, 0.009, 0.0}, 1000);
        rig.ticks(200);
        return rig.proxy_state().force.y;
    };
    EXPECT_NEAR(felt(1.0), 2.0, 1e-6);
    EXPECT_NEAR(felt(0.5), 4.0, 1e-6);
}

}  // namespace
}  // namespace tactus::hand_mapping_test
