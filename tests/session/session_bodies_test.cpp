// What a session makes of bodies: what falls, rests, is pushed, joined, moved by its owner and removed.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <thread>

#include "core/haptics/fading_force.hpp"
#include "session_rig.hpp"

namespace tactus::session_bodies_test {
namespace {

using namespace session_test;

TEST(Session, BodiesMadeElsewhereMayShareTheirTouch) {
    SessionRig rig;
    BodyAddition addition = body(BoxShape{Vec3(0.1)}, {0.0, -0.1, 0.0}, Motion::Static);
    addition.touch = make_touch_shape(addition.description.shapes).shape;
    ReadyBody first, second;
    std::thread other([&] { first = rig.session.prepare_body(addition); });
    other.join();
    addition.description.pose.position.x = 1.0;
    second = rig.session.prepare_body(addition);
    EXPECT_NE(rig.session.add_body(std::move(first)).handle, no_handle);
    EXPECT_NE(rig.session.add_body(std::move(second)).handle, no_handle);
    EXPECT_GE(addition.touch.use_count(), 3);
    rig.device.position = {0.0, 0.05, 0.0};
    rig.draw({0.0, 0.0, 0.0}, 100);
    EXPECT_NEAR(rig.device.force.y, 5.0, 1e-6);
}

TEST(Session, APushActsInEveryTickUntilItIsTakenAway) {
    SessionSettings settings;
    settings.physics.gravity = Vec3(0.0);
    SessionRig rig(settings);
    const SessionHandle ball = rig.add(body(SphereShape{0.1}, Vec3(0.0), Motion::Dynamic, 2.0));
    rig.session.set_body_push(ball, {4.0, 0.0, 0.0}, Vec3(0.0));
    rig.ticks(500);
    EXPECT_NEAR(rig.state_of(ball)->linear_velocity.x, 1.0, 5e-3);
    rig.session.set_body_push(ball, Vec3(0.0), Vec3(0.0));
    rig.ticks(500);
    EXPECT_NEAR(rig.state_of(ball)->linear_velocity.x, 1.0, 5e-3);
}

TEST(Session, AJointIsGivenInTheFrameOfItsBody) {
    SessionRig rig;
    BodyAddition turned = body(SphereShape{0.05}, {1.0, 2.0, 0.0}, Motion::Dynamic);
    turned.description.pose.rotation = glm::angleAxis(std::numbers::pi / 2.0, Vec3(0.0, 0.0, 1.0));
    const SessionHandle ball = rig.add(turned);
    // A quarter of a metre along the body's y, which is the world's -x.
    const AddResult joint = rig.session.add_joint(
        {.kind = JointKind::Pin, .frame = {{0.0, 0.25, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}}, ball, no_handle);
    EXPECT_EQ(joint.error, "");
    for (int i = 0; i < 1'000; ++i) {
        rig.tick();
        ASSERT_NEAR(glm::distance(rig.state_of(ball)->pose.position, Vec3(0.75, 2.0, 0.0)), 0.25, 1e-3);
    }
    rig.session.remove_joint(joint.handle);
    rig.ticks(1'000);
    EXPECT_LT(rig.state_of(ball)->pose.position.y, 1.0);
}

TEST(Session, JointsAreGivenBackWhenTheirBodyHasGone) {
    SessionSettings settings;
    settings.physics.max_joints = 2;
    SessionRig rig(settings);
    for (int round = 0; round < 5; ++round) {
        const SessionHandle ball = rig.add(body(SphereShape{0.05}, {0.0, 2.0, 0.0}, Motion::Dynamic));
        const AddResult joint = rig.session.add_joint({.frame = {}}, ball, no_handle);
        ASSERT_EQ(joint.error, "");
        rig.tick();
        rig.session.remove_body(ball);
        rig.session.remove_joint(joint.handle);
        rig.tick();
        rig.session.collect();
    }
}

TEST(Session, AFingerPushesABoxAndFeelsTheOppositeForce) {
    SessionSettings settings;
    SessionRig rig(settings);
    rig.session.set_gravity(Vec3(0.0));
    const SessionHandle box = rig.add(body(BoxShape{Vec3(0.1)}, {0.0, 0.0, 0.0}, Motion::Dynamic, 2.0));
    rig.device.position = {-0.2, 0.0, 0.0};
    rig.tick();
    rig.device.velocity.x = 0.4;
    Vec3 given(0.0);
    for (int i = 0; i < 400; ++i) {
        rig.device.position.x = -0.2 + 0.0004 * i;
        rig.tick();
        given += -rig.device.force * 1e-3;  // what the box got from the finger (unit: newton-seconds)
    }
    rig.tick();
    const BodyState* const state = rig.state_of(box);
    ASSERT_NE(state, nullptr);
    EXPECT_GT(given.x, 0.1);
    // No friction, no gravity: the box has the momentum the finger gave it.
    EXPECT_NEAR(2.0 * state->linear_velocity.x, given.x, 0.01 * given.x);
    EXPECT_GT(state->pose.position.x, 0.0);
    EXPECT_NEAR(state->linear_velocity.y, 0.0, 1e-6);
}

TEST(Session, ABoxPushedOffItsCentreTurns) {
    SessionRig rig;
    rig.session.set_gravity(Vec3(0.0));
    const SessionHandle box = rig.add(body(BoxShape{Vec3(0.1)}, Vec3(0.0), Motion::Dynamic, 2.0));
    rig.device.position = {-0.2, 0.0, 0.08};
    rig.tick();
    rig.draw({-0.05, 0.0, 0.08}, 300);
    rig.tick();
    // Pushed along +x at z > 0: the turn is about +y.
    EXPECT_GT(rig.state_of(box)->angular_velocity.y, 0.01);
}

TEST(Session, AFallingBoxLiesStillOnTheGroundAndSleeps) {
    SessionRig rig;
    rig.add(ground());
    const SessionHandle box = rig.add(body(BoxShape{Vec3(0.1)}, {0.5, 0.3, 0.0}, Motion::Dynamic));
    rig.device.position = {0.0, 1.0, 0.0};
    rig.ticks(3'000);
    EXPECT_NEAR(rig.state_of(box)->pose.position.y, 0.1, 2e-3);
    EXPECT_EQ(rig.newest().awake_bodies, 0u);
}

TEST(Session, ASceneAtRestTakesNoPhysicsStep) {
    SessionRig rig;
    rig.add(ground());
    rig.add(body(BoxShape{Vec3(0.1)}, {0.5, 0.1, 0.0}, Motion::Static));
    rig.device.position = {0.0, 0.1, 0.0};
    rig.tick();
    rig.draw({0.3, -0.02, 0.1}, 500);
    EXPECT_TRUE(rig.proxy_state().status & proxy_touching);
    EXPECT_EQ(rig.newest().physics_steps, 0u);
}

TEST(Session, ASceneThatCameToRestTakesNoMore) {
    SessionRig rig;
    rig.add(ground());
    rig.add(body(BoxShape{Vec3(0.1)}, {0.5, 0.3, 0.0}, Motion::Dynamic));
    rig.device.position = {0.0, 1.0, 0.0};
    rig.ticks(3'000);
    const std::uint64_t steps = rig.newest().physics_steps;
    EXPECT_GT(steps, 500u);
    EXPECT_LT(steps, 3'000u);
    rig.ticks(500);
    EXPECT_EQ(rig.newest().physics_steps, steps);
}

TEST(Session, ManyAwakeBodiesAreSlowedWhereNoHandIsAndSayHowMany) {
    SessionSettings settings;
    settings.full_rate_bodies = 16;
    SessionRig rig(settings);
    rig.device.position = {0.0, 0.0, 0.3};
    std::vector<SessionHandle> boxes;
    for (int i = 0; i < 60; ++i) {
        BodyAddition addition = body(BoxShape{Vec3(0.05)}, {0.2 * i, 0.0, 0.0}, Motion::Dynamic);
        addition.description.linear_velocity = {0.0, 0.0, 0.1};
        addition.description.gravity_scale = 0.0;
        boxes.push_back(rig.add(addition));
    }
    rig.ticks(100);
    EXPECT_EQ(rig.newest().awake_bodies, 60u);
    EXPECT_GE(rig.newest().slowed_bodies, 44u);
    EXPECT_LE(rig.newest().slowed_bodies, 48u);
    rig.ticks(900);
    for (const SessionHandle box : boxes) {
        EXPECT_NEAR(rig.state_of(box)->pose.position.z, 0.1, 2e-3);
        EXPECT_NEAR(rig.state_of(box)->linear_velocity.z, 0.1, 1e-6);
    }
}

// A U of three slabs. To the finger it is what it looks like, to other bodies its hull.
TEST(Session, AMovingConcaveMeshIsTouchedInItsHollow) {
    auto channel = std::make_shared<TriangleMesh>();
    const auto slab = [&channel](const Vec3& low, const Vec3& high) {
        const auto first = static_cast<std::uint32_t>(channel->vertices.size());
        for (int i = 0; i < 8; ++i) {
            channel->vertices.emplace_back((i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y,
                                           (i & 4) ? high.z : low.z);
        }
        for (const std::array<std::uint32_t, 3>& t : {std::array<std::uint32_t, 3>{0, 2, 1},
                                                      {1, 2, 3},
                                                      {4, 5, 6},
                                                      {5, 7, 6},
                                                      {0, 1, 4},
                                                      {1, 5, 4},
                                                      {2, 6, 3},
                                                      {3, 6, 7},
                                                      {0, 4, 2},
                                                      {2, 4, 6},
                                                      {1, 3, 5},
                                                      {3, 7, 5}}) {
            channel->triangles.push_back({first + t[0], first + t[1], first + t[2]});
        }
    };
    slab({-0.10, 0.0, -0.1}, {0.10, 0.02, 0.1});
    slab({-0.10, 0.0, -0.1}, {-0.08, 0.1, 0.1});
    slab({0.08, 0.0, -0.1}, {0.10, 0.1, 0.1});
    SessionRig rig;
    rig.add(ground());
    const SessionHandle handle = rig.add(body(MeshShape{channel}, Vec3(0.0), Motion::Dynamic, 2.0));
    const SessionHandle ball = rig.add(body(SphereShape{0.03}, {0.0, 0.15, 0.05}, Motion::Dynamic, 0.1));
    rig.device.position = {0.0, 0.3, -0.05};
    rig.tick();
    rig.draw({0.0, 0.02, -0.05}, 500);
    rig.ticks(500);
    // The finger of 10 mm is on the floor of the hollow, the ball on its lid.
    const Pose& pose = rig.state_of(handle)->pose;
    EXPECT_NEAR(to_local(pose, rig.proxy_state().position).y, 0.03, 1e-5);
    EXPECT_NEAR(to_local(pose, rig.state_of(ball)->pose.position).y, 0.13, 1e-3);
    // And a wall holds it from the side.
    rig.draw({0.09, 0.02, -0.05}, 500);
    EXPECT_NEAR(to_local(rig.state_of(handle)->pose, rig.proxy_state().position).x, 0.07, 1e-5);
}

TEST(Session, AKinematicBodyMovedByItsOwnerArrivesInTime) {
    SessionRig rig;
    const SessionHandle door = rig.add(body(BoxShape{Vec3(0.1)}, Vec3(0.0), Motion::Kinematic));
    rig.device.position = {0.0, 1.0, 0.0};
    rig.tick();
    rig.session.move_body(door, {{0.5, 0.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}, 0.1);
    rig.ticks(102);
    EXPECT_NEAR(rig.state_of(door)->pose.position.x, 0.5, 1e-9);
    rig.ticks(50);
    EXPECT_NEAR(rig.state_of(door)->pose.position.x, 0.5, 1e-9);
    EXPECT_LT(glm::length(rig.state_of(door)->linear_velocity), 1e-12);
}

TEST(Session, AMovingDoorPushesTheFinger) {
    SessionRig rig;
    const SessionHandle door =
        rig.add(body(BoxShape{Vec3(0.02, 0.5, 0.5)}, {-0.5, 0.0, 0.0}, Motion::Kinematic));
    rig.device.position = {0.0, 0.0, 0.0};
    rig.tick();
    rig.session.move_body(door, {{0.1, 0.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}, 0.2);
    rig.ticks(300);
    EXPECT_NEAR(rig.proxy_state().position.x, 0.13, 1e-5);
    EXPECT_NEAR(rig.device.force.x, 500.0 * 0.13, 0.05);
}

TEST(Session, ARemovedBodyIsGoneFromTouchAndPhysics) {
    SessionRig rig;
    const SessionHandle floor = rig.add(ground());
    rig.device.position = {0.0, 0.1, 0.0};
    rig.tick();
    rig.draw({0.0, -0.02, 0.0}, 50);
    EXPECT_GT(rig.device.force.y, 1.0);
    rig.session.remove_body(floor);
    // What is no longer there is let go of, not dropped.
    Vec3 before = rig.device.force;
    for (int i = 0; i < 200; ++i) {
        rig.tick();
        EXPECT_LE(glm::distance(rig.device.force, before), FadingForce::max_step + 1e-9);
        before = rig.device.force;
    }
    EXPECT_EQ(rig.device.force, Vec3(0.0));
}

}  // namespace
}  // namespace tactus::session_bodies_test
