// What a session makes of devices: the hand, the workspace it is in, the force it is given.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>

#include "core/math/body_motion.hpp"
#include "session_rig.hpp"

namespace tactus::session_hands_test {
namespace {

using namespace session_test;

TEST(Session, AHandPressedIntoTheGroundIsPushedBack) {
    SessionRig rig;
    rig.add(ground());
    rig.device.position = {0.0, 0.1, 0.0};
    rig.tick();
    rig.draw({0.0, -0.02, 0.0}, 50);
    EXPECT_NEAR(rig.device.force.y, 500.0 * 0.03, 1e-3);
    EXPECT_NEAR(rig.proxy_state().position.y, 0.01, 1e-6);
    EXPECT_TRUE(rig.proxy_state().status & proxy_touching);
}

TEST(Session, WithoutADeviceAProxyRests) {
    Session session({});
    ProxyDescription description;
    ASSERT_NE(session.add_proxy(description).handle, no_handle);
    session.tick(period);
    session.refresh();
    EXPECT_EQ(session.snapshot().proxies[0].force, Vec3(0.0));
}

TEST(Session, ForcesAreLimitedToWhatTheDeviceMayTake) {
    SessionRig rig;
    rig.add(ground());
    Workspace workspace;
    workspace.force_limit = 3.0;
    rig.session.set_workspace(rig.hand, workspace);
    rig.device.position = {0.0, 0.1, 0.0};
    rig.tick();
    rig.draw({0.0, -0.05, 0.0}, 50);
    EXPECT_NEAR(glm::length(rig.device.force), 3.0, 1e-12);
    EXPECT_TRUE(rig.tick() & session_force_limited);
}

TEST(Session, WithoutItsDeadManButtonADeviceIsGivenNoForce) {
    SessionRig rig;
    rig.add(ground());
    Workspace workspace;
    workspace.dead_man = 0b10;
    rig.session.set_workspace(rig.hand, workspace);
    rig.device.position = {0.0, 0.1, 0.0};
    rig.tick();
    rig.draw({0.0, -0.005, 0.0}, 50);
    EXPECT_EQ(rig.device.force, Vec3(0.0));
    rig.device.buttons = 0b10;
    rig.tick();
    EXPECT_NEAR(rig.device.force.y, 500.0 * 0.015, 1e-6);
    rig.device.buttons = 0b01;
    rig.tick();
    EXPECT_EQ(rig.device.force, Vec3(0.0));
    rig.session.refresh();
    EXPECT_EQ(rig.session.snapshot().devices[0].safety, HandState::released);
}

// 0.2 N s/m bear 200 N/m at a tick of a millisecond with half of one more; a workspace twice as large in the
// scene halves that.
TEST(Session, AWallThatADeviceCannotBearIsAsStiffAsItCan) {
    for (const double scale : {1.0, 2.0}) {
        SessionRig rig;
        rig.add(ground());
        Workspace workspace;
        workspace.force_limit = 1e6;
        workspace.scale = scale;
        rig.session.set_workspace(rig.hand, workspace);
        rig.device.can.feels = true;
        rig.device.can.damping = 0.2;
        rig.device.can.delay = 0.0005;
        rig.device.position = {0.0, 0.1 / scale, 0.0};
        rig.tick();
        rig.draw({0.0, -0.02 / scale, 0.0}, 50);
        EXPECT_NEAR(rig.device.force.y, 200.0 / scale * 0.03, 1e-6);
        rig.session.refresh();
        const DeviceState& state = rig.session.snapshot().devices[0];
        EXPECT_EQ(state.stiffness_wanted, 500.0);
        EXPECT_NEAR(state.stiffness_used, 200.0 / scale, 1e-9);
    }
}

// A wall that was not safe is told of until another one is pressed, or until the scale is another one.
TEST(Session, AWallThatWasNotSafeIsNotSaidForEver) {
    for (const bool is_scaled_back : {true, false}) {
        SessionRig rig;
        const SessionHandle floor = rig.add(ground());
        Workspace workspace;
        workspace.force_limit = 1e6;
        workspace.scale = 1000.0;
        rig.session.set_workspace(rig.hand, workspace);
        rig.device.can.feels = true;
        rig.device.can.damping = 1.0;
        rig.device.position = {0.0, 1e-4, 0.0};
        const auto used = [&rig] {
            rig.session.refresh();
            return rig.session.snapshot().devices[0].stiffness_used;
        };
        rig.tick();
        rig.draw({0.0, -1e-5, 0.0}, 50);
        EXPECT_NEAR(used(), 2.0, 1e-9) << "of 500 N/m";
        rig.draw({0.0, 1e-4, 0.0}, 50);
        EXPECT_NEAR(used(), 2.0, 1e-9) << "as long as nothing else is pressed";
        if (is_scaled_back) {
            workspace.scale = 1.0;
            rig.session.set_workspace(rig.hand, workspace);
            rig.tick();
            EXPECT_EQ(used(), 0.0);
        } else {
            rig.session.set_touch_material(floor, {1.0, 0.0, 0.0, 0.0});
        }
        rig.draw({0.0, -1e-5, 0.0}, 50);
        EXPECT_EQ(used(), 0.0);
    }
}

TEST(Session, AHandThatHasJumpedIsNotPushed) {
    SessionRig rig;
    rig.add(ground());
    rig.device.can.max_speed = 5.0;
    rig.device.position = {0.0, 0.01, 0.0};
    rig.tick();
    rig.draw({0.0, -0.01, 0.0}, 50);
    EXPECT_GT(rig.device.force.y, 1.0);
    rig.device.position.y = -0.02;
    rig.tick();
    EXPECT_EQ(rig.device.force, Vec3(0.0));
    rig.tick();
    EXPECT_GT(rig.device.force.y, 1.0);
}

// Each field of a reading alone: no force at once, whatever the hand does meanwhile, and it grows again.
TEST(Session, AReadingOfWhichOneFieldMakesNoSenseGivesNoForce) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinite = std::numeric_limits<double>::infinity();
    using Spoil = void (*)(HeldDevice&);
    const Spoil spoils[] = {
        [](HeldDevice& d) { d.position.x = nan; },
        [](HeldDevice& d) { d.position.y = infinite; },
        [](HeldDevice& d) { d.position.z = 1e30; },
        [](HeldDevice& d) { d.velocity.x = nan; },
        [](HeldDevice& d) { d.velocity.y = -infinite; },
        [](HeldDevice& d) { d.velocity.z = 1e30; },
        [](HeldDevice& d) { d.rotation.w = nan; },
        [](HeldDevice& d) { d.rotation.x = infinite; },
        [](HeldDevice& d) { d.rotation = Quat(0.0, 0.0, 0.0, 0.0); },
        [](HeldDevice& d) { d.rotation.y = 3.0; },
    };
    for (std::size_t i = 0; i < std::size(spoils); ++i) {
        SessionRig rig;
        rig.add(ground());
        rig.device.can.feels = true;
        rig.device.can.ramp = 0.1;
        rig.device.can.max_slew = 4000.0;
        rig.device.can.max_speed = 5.0;
        rig.device.position = {0.0, 0.1, 0.0};
        rig.tick();
        rig.draw({0.0, 0.002, 0.0}, 500);
        ASSERT_NEAR(rig.device.force.y, 4.0, 1e-6) << i;
        for (int tick = 1; tick <= 50; ++tick) {
            rig.device.position = {0.0, 0.002 + 0.001 * tick, 0.0};
            rig.device.velocity = Vec3(0.0);
            spoils[i](rig.device);
            rig.tick();
            EXPECT_EQ(rig.device.force, Vec3(0.0)) << i << ", tick " << tick;
        }
        rig.session.refresh();
        EXPECT_EQ(rig.session.snapshot().devices[0].safety, HandState::no_number) << i;
        rig.device.rotation = Quat(1.0, 0.0, 0.0, 0.0);
        rig.device.velocity = Vec3(0.0);
        rig.device.position = {0.0, 0.002, 0.0};
        double before = 0.0;
        for (int tick = 0; tick < 200; ++tick) {
            rig.tick();
            EXPECT_LE(rig.device.force.y - before, 4.0) << i;
            before = rig.device.force.y;
        }
        EXPECT_NEAR(before, 4.0, 1e-6) << i;
    }
}

// What a field says may be a number and be wrong: it leaps, repeats itself, or nothing new comes at all. In
// two ticks the force has gone; then it grows, also where what was said stays.
TEST(Session, AFieldThatLeapsOrRepeatsItselfGivesNoForceAndItGrowsAgain) {
    struct Lie {
        const char* name;
        void (*tell)(HeldDevice&);
        HandState state;
    };
    const Lie lies[] = {
        {"position leaps", [](HeldDevice& d) { d.position.x += 0.02; }, HandState::jumped},
        {"velocity leaps", [](HeldDevice& d) { d.velocity.z = 6.0; }, HandState::jumped},
        {"rotation leaps", [](HeldDevice& d) { d.rotation = Quat(0.0, 1.0, 0.0, 0.0); }, HandState::jumped},
        {"buttons leap", [](HeldDevice& d) { d.buttons = 0; }, HandState::released},
        {"position is frozen", [](HeldDevice& d) { d.velocity.x = 1.0; }, HandState::frozen},
        {"velocity is frozen", [](HeldDevice& d) { d.velocity.y = -0.6; }, HandState::frozen},
        {"nothing new", [](HeldDevice& d) { d.connected = false; }, HandState::disconnected},
    };
    for (const Lie& lie : lies) {
        SessionRig rig;
        rig.add(ground());
        Workspace workspace;
        workspace.force_limit = 1e6;
        workspace.dead_man = 1;
        rig.session.set_workspace(rig.hand, workspace);
        rig.device.can.feels = rig.device.can.rotates = true;
        rig.device.can.ramp = 0.1;
        rig.device.can.max_slew = 4000.0;
        rig.device.can.max_speed = 5.0;
        rig.device.buttons = 1;
        rig.device.position = {0.0, 0.1, 0.0};
        rig.tick();
        rig.draw({0.0, 0.002, 0.0}, 500);
        ASSERT_NEAR(rig.device.force.y, 4.0, 1e-6) << lie.name;
        lie.tell(rig.device);
        rig.ticks(2);
        const bool is_passing = lie.state == HandState::jumped && rig.device.velocity == Vec3(0.0);
        if (!is_passing) {
            EXPECT_EQ(rig.device.force, Vec3(0.0)) << lie.name;
            EXPECT_EQ(rig.newest().devices[0].safety, lie.state) << lie.name;
        }
        EXPECT_LE(rig.device.force.y, 0.05) << lie.name << ": a ramp begins anew";
        rig.device.velocity = Vec3(0.0);
        rig.device.buttons = 1;
        rig.device.connected = true;
        double before = rig.device.force.y;
        for (int tick = 0; tick < 200; ++tick) {
            rig.tick();
            EXPECT_LE(rig.device.force.y - before, 0.05) << lie.name;
            before = rig.device.force.y;
        }
        EXPECT_NEAR(before, 4.0, 1e-6) << lie.name;
    }
}

// Rotations come seldom from a grip without a cable, and are no leaps.
TEST(Session, AHandleThatTurnsFastIsPushed) {
    SessionRig rig;
    rig.add(ground());
    rig.device.can.feels = rig.device.can.rotates = true;
    rig.device.position = {0.0, 0.1, 0.0};
    rig.tick();
    rig.draw({0.0, 0.002, 0.0}, 500);
    for (int tick = 0; tick < 200; ++tick) {
        if (tick % 10 == 0) {
            rig.device.rotation = turn_by(Vec3(0.0, 0.0, 40.0), 0.001 * tick);
        }
        rig.tick();
        ASSERT_NEAR(rig.device.force.y, 4.0, 1e-6) << tick;
    }
}

// A ball falls past where the hand would be, and bounces off one that is there.
TEST(Session, AHandWhoseDeviceIsNotThereTouchesNothing) {
    for (const bool is_there : {false, true}) {
        SessionRig rig;
        rig.device.connected = is_there;
        BodyAddition ball = body(SphereShape{0.05}, {0.01, 0.2, 0.0}, Motion::Dynamic, 0.2);
        const SessionHandle falling = rig.add(ball);
        rig.ticks(1'000);
        EXPECT_EQ(rig.proxy_state().status & touch_unheld, is_there ? 0u : touch_unheld);
        const BodyState* state = rig.state_of(falling);
        ASSERT_NE(state, nullptr);
        EXPECT_EQ(std::abs(state->pose.position.x - 0.01) < 1e-9, !is_there);
    }
}

// A reading that fails loses no contact; a device that stays away loses its hand, and finds it again.
TEST(Session, AHandLeavesAQuarterOfASecondAfterItsDevice) {
    SessionRig rig;
    rig.add(ground());
    rig.device.position = {0.0, 0.1, 0.0};
    rig.tick();
    rig.draw({0.0, 0.0, 0.0}, 50);
    rig.device.connected = false;
    rig.ticks(200);
    EXPECT_TRUE(rig.proxy_state().status & proxy_touching);
    EXPECT_EQ(rig.device.force, Vec3(0.0));
    rig.ticks(100);
    EXPECT_EQ(rig.proxy_state().status, touch_unheld);
    rig.device.connected = true;
    rig.device.position = {0.0, 0.1, 0.0};
    rig.tick();
    rig.draw({0.0, 0.0, 0.0}, 50);
    EXPECT_TRUE(rig.proxy_state().status & proxy_touching);
    EXPECT_NEAR(rig.device.force.y, 5.0, 1e-6);
}

// Within all that limits a force.
TEST(Session, AnArmIsCarriedWhereAForceMayBeGiven) {
    SessionRig rig;
    rig.device.can.feels = true;
    rig.device.can.weight = 3.0;
    Workspace workspace;
    workspace.force_limit = 8.0;
    workspace.dead_man = 0b1;
    rig.device.buttons = 0b1;
    rig.session.set_workspace(rig.hand, workspace);
    double before = 0.0;
    for (int tick = 0; tick < 600; ++tick) {
        rig.tick();
        EXPECT_LE(rig.device.force.y - before, 0.01);
        before = rig.device.force.y;
    }
    EXPECT_EQ(rig.device.force, Vec3(0.0, 3.0, 0.0));
    rig.device.buttons = 0;
    rig.tick();
    EXPECT_EQ(rig.device.force, Vec3(0.0)) << "the button is up";
    rig.device.buttons = 0b1;
    workspace.force_limit = 1.0;
    rig.session.set_workspace(rig.hand, workspace);
    rig.ticks(600);
    EXPECT_NEAR(rig.device.force.y, 1.0, 1e-12);
    workspace.force_limit = 0.0;
    rig.session.set_workspace(rig.hand, workspace);
    rig.tick();
    EXPECT_EQ(rig.device.force, Vec3(0.0)) << "the limit is nothing";
    workspace.force_limit = 8.0;
    workspace.clutch = true;
    rig.session.set_workspace(rig.hand, workspace);
    rig.tick();
    EXPECT_EQ(rig.device.force, Vec3(0.0)) << "the clutch is held";
}

TEST(Session, AnArmThatPressesIsCarriedWithinTheLimitOfBoth) {
    SessionRig rig;
    rig.add(ground());
    rig.device.can.feels = true;
    rig.device.can.weight = 2.0;
    Workspace workspace;
    workspace.force_limit = 3.0;
    rig.session.set_workspace(rig.hand, workspace);
    rig.device.position = {0.0, 0.1, 0.0};
    rig.ticks(600);
    for (int i = 0; i < 60; ++i) {
        rig.draw(rig.device.position - Vec3(0.0, 2e-3, 0.0), 10);
        EXPECT_LE(glm::length(rig.device.force), 3.0 + 1e-12);
    }
    EXPECT_NEAR(rig.device.force.y, 3.0, 1e-9);
}

TEST(Session, AnArmIsNotCarriedWhereItsReadingMakesNoSense) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const auto lies = std::to_array<void (*)(HeldDevice&)>({
        [](HeldDevice& device) { device.position.y = nan; },
        [](HeldDevice& device) { device.velocity.x = nan; },
        [](HeldDevice& device) { device.rotation.w = nan; },
        [](HeldDevice& device) { device.position.x += 1.0; },
        [](HeldDevice& device) { device.connected = false; },
    });
    for (const auto& lie : lies) {
        SessionRig rig;
        rig.device.can.feels = true;
        rig.device.can.weight = 3.0;
        rig.device.can.max_speed = 5.0;
        rig.ticks(600);
        ASSERT_EQ(rig.device.force, Vec3(0.0, 3.0, 0.0));
        lie(rig.device);
        rig.tick();
        EXPECT_EQ(rig.device.force, Vec3(0.0)) << &lie - lies.data();
    }
}

TEST(Session, AWorkspaceTurnsPositionsInAndForcesBack) {
    SessionRig rig;
    rig.add(ground());
    Workspace workspace;
    workspace.force_limit = 1e6;
    workspace.pose = {{0.0, 1.0, 0.0},
                      Quat(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5))};  // a quarter turn about z: x to y
    workspace.scale = 2.0;
    rig.session.set_workspace(rig.hand, workspace);
    rig.device.position = {-0.3, 0.0, 0.0};
    rig.tick();
    EXPECT_LT(glm::length(rig.proxy_state().hand - Vec3(0.0, 0.4, 0.0)), 1e-12);
    rig.draw({-0.51, 0.0, 0.0}, 100);  // 0.02 below the ground in the scene
    EXPECT_NEAR(rig.device.force.x, 500.0 * 0.03, 1e-3);
    EXPECT_NEAR(rig.device.force.y, 0.0, 1e-9);
}

TEST(Session, AHeldClutchKeepsTheHandWhereItIs) {
    SessionRig rig;
    rig.device.position = {0.1, 0.2, 0.3};
    rig.ticks(2);
    Workspace held;
    held.clutch = true;
    rig.session.set_workspace(rig.hand, held);
    rig.tick();
    rig.draw({0.5, 0.5, 0.5}, 20);
    EXPECT_LT(glm::length(rig.proxy_state().hand - Vec3(0.1, 0.2, 0.3)), 1e-12);
    rig.session.set_workspace(rig.hand, {});
    rig.tick();
    rig.draw({0.6, 0.5, 0.5}, 20);
    EXPECT_LT(glm::length(rig.proxy_state().hand - Vec3(0.2, 0.2, 0.3)), 1e-12);
}

TEST(Session, ATorqueFollowsTheDevicesFrameAndIsLimitedByTheDevice) {
    SessionRig rig;
    Workspace turned;
    turned.pose.rotation =
        Quat(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5));  // x of the device is y of the scene
    turned.torque = {0.0, 0.1, 0.0};
    rig.session.set_workspace(rig.hand, turned);
    rig.ticks(3);
    EXPECT_EQ(rig.device.torque, Vec3(0.0)) << "it has no motors for that";
    rig.device.can.max_torque = 0.05;
    rig.tick();
    EXPECT_LT(glm::distance(rig.device.torque, Vec3(0.05, 0.0, 0.0)), 1e-12);
    EXPECT_LT(glm::distance(rig.newest().devices[0].torque, Vec3(0.0, 0.05, 0.0)), 1e-12);
    rig.session.rest();
    EXPECT_EQ(rig.device.torque, Vec3(0.0));
    EXPECT_EQ(rig.newest().devices[0].torque, Vec3(0.0));
}

TEST(Session, AtRestTheDeviceIsGivenNoForce) {
    SessionRig rig;
    rig.add(ground());
    rig.device.position = {0.0, 0.05, 0.0};
    rig.draw({0.0, -0.01, 0.0}, 100);
    EXPECT_GT(rig.device.force.y, 1.0);
    rig.session.rest();
    EXPECT_EQ(rig.device.force, Vec3(0.0));
    EXPECT_EQ(rig.proxy_state().force, Vec3(0.0));
    EXPECT_EQ(rig.session.snapshot().devices[0].force, Vec3(0.0));
}

TEST(Session, AHandThatStayedGoesOnAfterARest) {
    SessionRig rig;
    rig.add(ground());
    rig.device.position = {0.0, 0.05, 0.0};
    rig.draw({0.0, -0.01, 0.0}, 100);
    const double before = rig.device.force.y;
    rig.session.rest();
    rig.tick();
    EXPECT_DOUBLE_EQ(rig.device.force.y, before);
}

TEST(Session, AHandThatWentElsewhereDuringARestIsNotKicked) {
    SessionRig rig;
    rig.add(ground());
    rig.device.position = {0.0, 0.05, 0.0};
    rig.ticks(10);
    rig.session.rest();
    rig.device.position = {0.0, -0.2, 0.0};
    rig.tick();
    EXPECT_EQ(rig.device.force, Vec3(0.0));
}

TEST(Session, ADeviceThatLeavesIsGivenNoForce) {
    SessionRig rig;
    rig.add(ground());
    rig.device.position = {0.0, 0.05, 0.0};
    rig.draw({0.0, -0.01, 0.0}, 100);
    EXPECT_GT(rig.device.force.y, 1.0);
    rig.session.remove_device(rig.hand);
    rig.tick();
    EXPECT_EQ(rig.device.force, Vec3(0.0));
}

}  // namespace
}  // namespace tactus::session_hands_test
