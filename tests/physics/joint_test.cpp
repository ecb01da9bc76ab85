#include "physics/joint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>

#include "core/math/body_motion.hpp"
#include "physics/physics_world.hpp"
#include "scene.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::joint_test {
namespace {

using namespace scene;

constexpr double pi = std::numbers::pi;
const Quat upright{1.0, 0.0, 0.0, 0.0};
// Turns the frame's z axis up.
const Quat z_up = glm::angleAxis(-pi / 2.0, Vec3(1.0, 0.0, 0.0));

PhysicsSettings weightless() {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    return settings;
}

// Angle about y (unit: radians).
double heading(const Pose& pose) {
    const Vec3 x = pose.rotation * Vec3(1.0, 0.0, 0.0);
    return std::atan2(-x.z, x.x);
}

// A door 0.8 m wide, hung at its left edge.
struct Door {
    explicit Door(JointRange range) : world(weightless()) {
        BodyDescription leaf = box({0.8, 2.0, 0.04}, {0.4, 1.0, 0.0}, 20.0);
        leaf.can_sleep = false;
        id = add(world, leaf);
        JointDescription hinge;
        hinge.kind = JointKind::Hinge;
        hinge.frame = {{0.0, 1.0, 0.0}, z_up};
        hinge.angular[2] = range;
        joint = world.add_joint(hinge, BodyId{}, id);
        EXPECT_TRUE(joint.valid());
    }
    PhysicsWorld world;
    BodyId id;
    JointId joint;
};

// M = F r = I w', I = m w^2 / 3 about the edge (and the leaf's thickness).
TEST(Joint, DoorTurnsAboutItsHinge) {
    Door door(JointRange::free());
    const double inertia = 20.0 * (0.64 / 3.0 + 0.0016 / 12.0);
    for (int i = 0; i < 500; ++i) {
        const Pose pose = door.world.pose(door.id);
        door.world.apply_force(door.id, direction_to_parent(pose, {0.0, 0.0, -5.0}),
                               to_parent(pose, {0.4, 0.0, 0.0}));
        door.world.step(tick);
    }
    const double expected = 0.5 * (5.0 * 0.8 / inertia) * 0.25;
    EXPECT_NEAR(heading(door.world.pose(door.id)), expected, 0.005 * expected);
    const Vec3 edge = to_parent(door.world.pose(door.id), {-0.4, 0.0, 0.0});
    EXPECT_LT(glm::length(edge - Vec3(0.0, 1.0, 0.0)), 1e-4);
}

TEST(Joint, HingeStopsAtItsLimits) {
    Door door({-0.2, 0.5});
    for (const double push : {-20.0, 20.0}) {
        for (int i = 0; i < 3000; ++i) {
            const Pose pose = door.world.pose(door.id);
            door.world.apply_force(door.id, direction_to_parent(pose, {0.0, 0.0, push}),
                                   to_parent(pose, {0.4, 0.0, 0.0}));
            door.world.step(tick);
        }
        EXPECT_NEAR(heading(door.world.pose(door.id)), push < 0.0 ? 0.5 : -0.2, 2e-3);
    }
}

TEST(Joint, HingeBetweenTwoBodiesCountsTheSecondAgainstTheFirst) {
    PhysicsWorld world(weightless());
    BodyDescription frame = box({0.1, 2.0, 0.1}, {-0.06, 1.0, 0.0}, 1.0);
    frame.motion = Motion::Static;
    const BodyId post = add(world, frame);
    const BodyId leaf = add(world, box({0.8, 2.0, 0.04}, {0.4, 1.0, 0.0}, 20.0));
    JointDescription hinge;
    hinge.kind = JointKind::Hinge;
    hinge.frame = {{0.0, 1.0, 0.0}, z_up};
    hinge.angular[2] = {0.3, 0.4};
    ASSERT_TRUE(world.add_joint(hinge, post, leaf).valid());
    run(world, 2000);
    EXPECT_GT(heading(world.pose(leaf)), 0.3 - 5e-3);
    EXPECT_LT(heading(world.pose(leaf)), 0.4 + 5e-3);
}

TEST(Joint, MotorTurnsTheHinge) {
    PhysicsWorld world(weightless());
    const BodyId wheel = add(world, box({0.2, 0.05, 0.2}, Vec3(0.0), 1.0));
    JointDescription hinge;
    hinge.kind = JointKind::Hinge;
    hinge.frame = {Vec3(0.0), z_up};
    hinge.angular[2] = JointRange::free();
    hinge.motor_speed = 3.0;
    hinge.motor_torque = 1.0;
    ASSERT_TRUE(world.add_joint(hinge, BodyId{}, wheel).valid());
    run(world, 500);
    EXPECT_NEAR(world.angular_velocity(wheel).y, 3.0, 1e-3);
}

// A pendulum of length l: T = 2 pi sqrt((l + 2 r^2 / (5 l)) / g) for small swings of a ball of radius r.
TEST(Joint, PinnedBallSwingsAsAPendulum) {
    PhysicsWorld world;
    const double length = 0.5;
    const double radius = 0.02;
    BodyDescription bob = ball(radius, {0.02, -length, 0.0}, 0.2);
    bob.can_sleep = false;
    const BodyId id = add(world, bob);
    ASSERT_TRUE(world.add_joint({JointKind::Pin, {Vec3(0.0), upright}}, BodyId{}, id).valid());
    int first = -1;
    int last = -1;
    int crossings = 0;
    double before = 0.02;
    for (int i = 0; i < 10000; ++i) {
        world.step(tick);
        const double x = world.pose(id).position.x;
        if (before > 0.0 && x <= 0.0) {
            first = first < 0 ? i : first;
            last = i;
            ++crossings;
        }
        before = x;
    }
    ASSERT_GT(crossings, 2);
    const double period = (last - first) * tick / (crossings - 1);
    const double effective = std::sqrt(length * length + 0.0004) + 0.4 * radius * radius / length;
    EXPECT_NEAR(period, 2.0 * pi * std::sqrt(effective / 9.81), 0.005 * period);
}

TEST(Joint, SliderMovesAlongItsAxisOnlyAndStops) {
    PhysicsWorld world;
    const BodyId id = add(world, box(Vec3(0.1), {1.0, 1.0, 1.0}, 1.0));
    JointDescription slider;
    slider.kind = JointKind::Slider;
    slider.frame = {{1.0, 1.0, 1.0}, upright};
    slider.linear[0] = {-0.05, 0.1};
    ASSERT_TRUE(world.add_joint(slider, BodyId{}, id).valid());
    for (int i = 0; i < 1000; ++i) {
        world.apply_force(id, {5.0, 2.0, 1.0}, to_parent(world.pose(id), {0.0, 0.05, 0.0}));
        world.step(tick);
    }
    const Pose pose = world.pose(id);
    EXPECT_NEAR(pose.position.x, 1.1, 1e-3);
    EXPECT_NEAR(pose.position.y, 1.0, 1e-3);
    EXPECT_NEAR(pose.position.z, 1.0, 1e-3);
    EXPECT_NEAR(std::abs(pose.rotation.w), 1.0, 1e-4);
}

TEST(Joint, SixAxesLimitEachOnItsOwn) {
    PhysicsWorld world(weightless());
    const BodyId id = add(world, box(Vec3(0.1), Vec3(0.0), 1.0));
    JointDescription joint;
    joint.kind = JointKind::SixAxes;
    joint.linear = {JointRange{-0.01, 0.02}, JointRange::free(), JointRange::locked()};
    ASSERT_TRUE(world.add_joint(joint, BodyId{}, id).valid());
    for (int i = 0; i < 500; ++i) {
        world.apply_force(id, {1.0, 1.0, 1.0}, world.center_of_mass(id));
        world.step(tick);
    }
    EXPECT_NEAR(world.pose(id).position.x, 0.02, 1e-4);
    EXPECT_NEAR(world.pose(id).position.y, 0.125, 1e-3);
    EXPECT_NEAR(world.pose(id).position.z, 0.0, 1e-4);
}

// Ranges that do not hold the place where the bodies are joined.
TEST(Joint, SixAxesDriveBodiesIntoRangesThatAreElsewhere) {
    PhysicsWorld world(weightless());
    const BodyId slid = add(world, box(Vec3(0.1), Vec3(0.0), 1.0));
    const BodyId turned = add(world, box(Vec3(0.1), {1.0, 0.0, 0.0}, 1.0));
    JointDescription joint;
    joint.kind = JointKind::SixAxes;
    joint.linear[1] = {0.03, 0.04};
    ASSERT_TRUE(world.add_joint(joint, BodyId{}, slid).valid());
    joint = {};
    joint.kind = JointKind::SixAxes;
    joint.frame.position = {1.0, 0.0, 0.0};
    joint.angular[0] = {0.2, 0.3};
    ASSERT_TRUE(world.add_joint(joint, BodyId{}, turned).valid());
    run(world, 2000);
    EXPECT_GT(world.pose(slid).position.y, 0.03 - 1e-4);
    EXPECT_LT(world.pose(slid).position.y, 0.04 + 1e-4);
    const double angle = 2.0 * std::atan2(world.pose(turned).rotation.x, world.pose(turned).rotation.w);
    EXPECT_GT(angle, 0.2 - 2e-3);
    EXPECT_LT(angle, 0.3 + 2e-3);
}

TEST(Joint, JoinedBodiesOverlapUnlessToldToCollide) {
    for (const bool collide : {false, true}) {
        PhysicsWorld world(weightless());
        const BodyId a = add(world, box(Vec3(0.1), Vec3(0.0), 1.0));
        const BodyId b = add(world, box(Vec3(0.1), {0.09, 0.0, 0.0}, 1.0));
        JointDescription joint;
        joint.kind = JointKind::SixAxes;
        joint.linear[0] = JointRange::free();
        joint.bodies_collide = collide;
        ASSERT_TRUE(world.add_joint(joint, a, b).valid());
        run(world, 200);
        const double apart = world.pose(b).position.x - world.pose(a).position.x;
        EXPECT_NEAR(apart, collide ? 0.1 : 0.09, 1e-3);
    }
}

// The world has no shapes: a joint with it takes no collision away.
TEST(Joint, WhatHangsFromTheWorldCollidesWithWhatIsInNoJoint) {
    Door door(JointRange::free());
    const BodyId thrown = add(door.world, ball(0.1, {0.7, 1.0, 1.0}, 1.0));
    door.world.set_velocity(thrown, {0.0, 0.0, -2.0}, Vec3(0.0));
    double nearest = 1.0;
    for (int i = 0; i < 600; ++i) {
        run(door.world, 1);
        nearest = std::min(nearest, to_local(door.world.pose(door.id), door.world.pose(thrown).position).z);
    }
    EXPECT_NEAR(nearest, 0.1 + 0.02, 2e-3);
    EXPECT_GT(heading(door.world.pose(door.id)), 0.01);
}

TEST(Joint, AHungDoorStopsAtAWall) {
    Door door(JointRange::free());
    BodyDescription wall = box({0.2, 2.0, 0.2}, {0.7, 1.0, -0.3}, 1.0);
    wall.motion = Motion::Static;
    add(door.world, wall);
    for (int i = 0; i < 1500; ++i) {
        door.world.apply_force(door.id, {0.0, 0.0, -5.0},
                               to_parent(door.world.pose(door.id), {0.3, 0.0, 0.0}));
        run(door.world, 1);
        EXPECT_LT(heading(door.world.pose(door.id)), 0.4) << i;
    }
}

TEST(Joint, APinnedBallRestsOnTheFloorBelowIt) {
    PhysicsWorld world;
    add(world, ground());
    const BodyId id = add(world, ball(0.1, {1.0, 0.5, 0.0}, 1.0));
    JointDescription pin;
    pin.frame.position = {-1.0, 0.0, 0.0};
    ASSERT_TRUE(world.add_joint(pin, id, BodyId{}).valid());
    for (int i = 0; i < 1500; ++i) {
        run(world, 1);
        EXPECT_GT(world.pose(id).position.y, 0.095) << i;
    }
}

TEST(Joint, RemovedJointLetsGo) {
    PhysicsWorld world;
    const BodyId id = add(world, ball(0.05, Vec3(0.0), 1.0));
    const JointId joint = world.add_joint({JointKind::Pin, {Vec3(0.0), upright}}, BodyId{}, id);
    run(world, 200);
    EXPECT_NEAR(world.pose(id).position.y, 0.0, 1e-4);
    EXPECT_TRUE(world.remove_joint(joint));
    EXPECT_FALSE(world.remove_joint(joint));
    run(world, 200);
    EXPECT_LT(world.pose(id).position.y, -0.1);
}

TEST(Joint, GoesWithItsBody) {
    PhysicsWorld world;
    const BodyId a = add(world, ball(0.05, Vec3(0.0), 1.0));
    const BodyId b = add(world, ball(0.05, {0.2, 0.0, 0.0}, 1.0));
    world.add_joint({JointKind::Pin, {{0.1, 0.0, 0.0}, upright}}, a, b);
    EXPECT_EQ(world.joint_count(), 1u);
    PreparedBody gone = world.remove(a);
    EXPECT_EQ(world.joint_count(), 0u);
    run(world, 10);
    EXPECT_TRUE(world.add(gone).valid());
}

TEST(Joint, RefusesWhatCannotBeJoined) {
    PhysicsWorld world;
    const BodyId floor = add(world, ground());
    const BodyId id = add(world, ball(0.05, Vec3(0.0), 1.0));
    EXPECT_FALSE(world.add_joint({}, floor, BodyId{}).valid());
    EXPECT_FALSE(world.add_joint({}, id, id).valid());
    EXPECT_FALSE(world.add_joint({}, id, BodyId{12345}).valid());
}

// A pose that is seen roughly, led to where the hinge can be: the anchor is held, the axes are one.
TEST(Joint, APoseIsLedOntoAHinge) {
    Door door(JointRange{-1.0, 1.0});
    const Quat open = glm::angleAxis(0.4, Vec3(0.0, 1.0, 0.0));
    const Pose seen{open * Vec3(0.4, 0.0, 0.0) + Vec3(0.003, 1.002, -0.001),
                    glm::angleAxis(0.02, glm::normalize(Vec3(1.0, 0.0, 1.0))) * open};
    const Pose held = door.world.on_joints(door.id, seen);
    EXPECT_LT(glm::length(to_parent(held, {-0.4, 0.0, 0.0}) - Vec3(0.0, 1.0, 0.0)), 1e-6);
    EXPECT_LT(glm::length(held.rotation * Vec3(0.0, 1.0, 0.0) - Vec3(0.0, 1.0, 0.0)), 1e-6);
    EXPECT_NEAR(heading(held), 0.4, 1e-3);
    const Pose again = door.world.on_joints(door.id, held);
    EXPECT_LT(glm::length(again.position - held.position), 1e-6);
    const Pose beyond{Vec3(0.0), glm::angleAxis(1.5, Vec3(0.0, 1.0, 0.0))};
    EXPECT_NEAR(heading(door.world.on_joints(door.id, beyond)), 1.0, 1e-6) << "its limit";
}

TEST(Joint, APoseIsLedOntoASliderAndAPin) {
    PhysicsWorld world(weightless());
    const BodyId sliding = add(world, ball(0.05, {0.2, 0.0, 0.0}, 1.0));
    const BodyId pinned = add(world, ball(0.05, {0.0, 0.0, 0.5}, 1.0));
    const BodyId loose = add(world, ball(0.05, {0.0, 0.0, 1.0}, 1.0));
    BodyDescription still = ball(0.05, {0.0, 0.0, 2.0}, 1.0);
    still.motion = Motion::Static;
    const BodyId wall = add(world, still);
    JointDescription slider{JointKind::Slider, {{0.0, 0.0, 0.0}, upright}};
    slider.linear[0] = {-0.1, 0.1};
    world.add_joint(slider, BodyId{}, sliding);
    world.add_joint({JointKind::Pin, {{0.0, 0.0, 0.4}, upright}}, pinned, wall);
    const Quat turned = glm::angleAxis(0.1, Vec3(0.0, 0.0, 1.0));
    const Pose slid = world.on_joints(sliding, {{0.25, 0.01, -0.02}, turned});
    EXPECT_NEAR(slid.position.x, 0.25, 2e-3) << "the frame slides, 0.2 m from where the body turns back";
    EXPECT_LT(glm::length(Vec3(0.0, slid.position.y, slid.position.z)), 1e-6);
    EXPECT_NEAR(slid.rotation.w, 1.0, 1e-12);
    EXPECT_NEAR(world.on_joints(sliding, {{0.5, 0.0, 0.0}, upright}).position.x, 0.3, 1e-6);
    const Pose hung = world.on_joints(pinned, {{0.01, 0.0, 0.5}, turned});
    EXPECT_LT(glm::length(to_parent(hung, {0.0, 0.0, -0.1}) - Vec3(0.0, 0.0, 0.4)), 1e-6);
    EXPECT_EQ(hung.rotation, turned) << "it turns as it likes";
    const Pose anywhere{{0.3, 0.2, 0.1}, turned};
    EXPECT_EQ(world.on_joints(loose, anywhere).position, anywhere.position);
}

TEST(Joint, SaysWhatIsWrong) {
    JointDescription joint;
    EXPECT_EQ(wrong_in(joint), "");
    joint.angular[1] = {0.0, 4.0};
    EXPECT_NE(wrong_in(joint), "");
    joint.angular[1] = JointRange::locked();
    joint.frame.position.x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(wrong_in(joint), "");
}

TEST(Joint, AddingSteppingAndRemovingAllocatesNothing) {
    PhysicsWorld world;
    const BodyId a = add(world, ball(0.05, Vec3(0.0), 1.0));
    const BodyId b = add(world, ball(0.05, {0.2, 0.0, 0.0}, 1.0));
    testing::AuditScope audit;
    for (const JointKind kind : {JointKind::Pin, JointKind::Hinge, JointKind::Slider, JointKind::SixAxes}) {
        const JointId joint = world.add_joint({kind, {{0.1, 0.0, 0.0}, upright}}, a, b);
        run(world, 5);
        world.remove_joint(joint);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations(), 0u) << audit.describe();
    EXPECT_EQ(audit.frees(), 0u) << audit.describe();
}

// --- drives

// A knob of 40 g, 30 mm across, that turns about z.
struct Knob {
    explicit Knob(const JointDrive& drive) : world(weightless()) {
        BodyDescription disc = box({0.03, 0.03, 0.02}, Vec3(0.0), 0.04);
        disc.can_sleep = false;
        id = add(world, disc);
        JointDescription hinge;
        hinge.kind = JointKind::Hinge;
        hinge.angular[2] = JointRange::free();
        hinge.drive = drive;
        EXPECT_EQ(wrong_in(hinge), "");
        EXPECT_TRUE(world.add_joint(hinge, BodyId{}, id).valid());
    }
    double angle() {
        return std::atan2((world.pose(id).rotation * Vec3(1.0, 0.0, 0.0)).y,
                          (world.pose(id).rotation * Vec3(1.0, 0.0, 0.0)).x);
    }
    void turn(double torque, int ticks) {
        for (int i = 0; i < ticks; ++i) {
            world.apply_torque(id, {0.0, 0.0, torque});
            world.step(tick);
        }
    }
    PhysicsWorld world;
    BodyId id;
};

constexpr double degree = pi / 180.0;
const JointDrive detents{.stiffness = 0.1, .damping = 5e-4, .pitch = 30.0 * degree, .strength = 0.02};

TEST(JointDrive, AKnobRestsInItsDetentsWithinADegree) {
    Knob knob(detents);
    knob.turn(0.01, 500);  // weaker than a detent: it gives, and comes back
    EXPECT_GT(knob.angle(), 3.0 * degree);
    EXPECT_LT(knob.angle(), 9.0 * degree);
    knob.turn(0.0, 1000);
    EXPECT_NEAR(knob.angle(), 0.0, degree);
    knob.turn(0.03, 1000);  // stronger: it goes on and on
    knob.turn(0.0, 2000);
    const double detent = std::round(knob.angle() / detents.pitch);
    EXPECT_NEAR(knob.angle(), detent * detents.pitch, degree);
    EXPECT_GT(glm::length(knob.world.pose(knob.id).rotation - Quat(1.0, 0.0, 0.0, 0.0)), 0.1);
}

TEST(JointDrive, ASpringHoldsItsTorqueAndRestsWhereItIsTold) {
    Knob knob({.stiffness = 0.1, .damping = 1e-3, .rest = 0.3});
    knob.turn(0.0, 3000);
    EXPECT_NEAR(knob.angle(), 0.3, 1e-3);
    knob.turn(0.01, 3000);
    EXPECT_NEAR(knob.angle(), 0.4, 2e-3);
}

// I w' = -B w.
TEST(JointDrive, ADamperSlowsDownByItsDamping) {
    Knob knob({.damping = 1e-5});
    const double inertia = 0.04 * 2.0 * 0.03 * 0.03 / 12.0;
    knob.world.set_velocity(knob.id, Vec3(0.0), {0.0, 0.0, 5.0});
    knob.turn(0.0, 500);
    const double left = 5.0 * std::exp(-1e-5 * 0.5 / inertia);
    EXPECT_NEAR(knob.world.angular_velocity(knob.id).z, left, 0.02 * left);
}

TEST(JointDrive, ALatchHoldsNearItsPlaceAlone) {
    Knob knob({.stiffness = 0.5, .damping = 5e-3, .reach = 0.05});
    knob.turn(0.02, 1000);
    EXPECT_NEAR(knob.angle(), 0.04, 2e-3);  // held
    knob.turn(0.03, 300);                   // torn away
    knob.turn(0.0, 2000);
    EXPECT_GT(std::abs(knob.angle()), 0.06);
}

// A block of 1 kg that slides along x and presses against nothing.
struct Rail {
    explicit Rail(const JointDescription& wanted) : world(weightless()) {
        BodyDescription block = box({0.1, 0.1, 0.1}, Vec3(0.0), 1.0);
        block.can_sleep = false;
        id = add(world, block);
        join(wanted);
    }
    void join(const JointDescription& wanted) {
        if (joint.valid()) {
            world.remove_joint(joint);
        }
        JointDescription slider = wanted;
        slider.frame = {};
        slider.second_frame = Pose{};
        joint = world.add_joint(slider, id, BodyId{});
        EXPECT_TRUE(joint.valid());
    }
    PhysicsWorld world;
    BodyId id;
    JointId joint;
};

JointDescription within(double lower, double upper) {
    JointDescription joint;
    joint.kind = JointKind::Slider;
    joint.linear[0] = {lower, upper};
    return joint;
}

TEST(JointDrive, ASliderOnASpringGivesByItsForce) {
    JointDescription sprung = within(-0.2, 0.2);
    sprung.drive = {.stiffness = 100.0, .damping = 20.0};
    Rail rail(sprung);
    for (int i = 0; i < 3000; ++i) {
        rail.world.apply_force(rail.id, {5.0, 0.0, 0.0}, rail.world.center_of_mass(rail.id));
        rail.world.step(tick);
    }
    EXPECT_NEAR(std::abs(rail.world.pose(rail.id).position.x), 0.05, 1e-3);
}

// A limit that is raised under a body moves it at a bounded speed, and that is its velocity.
TEST(JointDrive, ALimitThatIsMovedPushesGently) {
    Rail rail(within(-0.1, 0.1));
    rail.world.step(tick);
    rail.join(within(0.02, 0.1));
    double before = rail.world.pose(rail.id).position.x, fastest = 0.0;
    for (int i = 0; i < 100; ++i) {
        rail.world.step(tick);
        const double now = rail.world.pose(rail.id).position.x;
        EXPECT_NEAR((now - before) / tick, rail.world.linear_velocity(rail.id).x, 0.02) << i;
        fastest = std::max(fastest, std::abs(now - before) / tick);
        before = now;
    }
    EXPECT_LE(fastest, 0.11);
    for (int i = 0; i < 400; ++i) {
        rail.world.step(tick);
    }
    EXPECT_NEAR(std::abs(rail.world.pose(rail.id).position.x), 0.02, 5e-4);
    EXPECT_NEAR(rail.world.linear_velocity(rail.id).x, 0.0, 2e-3);
}

// The same of a slider that is held at one place, and of each of six axes.
TEST(JointDrive, EveryLimitThatIsMovedPushesGently) {
    constexpr double to = 0.05;
    std::vector<JointDescription> moved;
    for (const JointRange& range : {JointRange{to, to}, JointRange{to, 0.1}, JointRange{to, 0.05 + 1e-6}}) {
        moved.push_back(within(range.lower, range.upper));
        for (std::size_t axis = 0; axis < 6; ++axis) {
            JointDescription six;
            six.kind = JointKind::SixAxes;
            (axis < 3 ? six.linear : six.angular)[axis % 3] = range;
            moved.push_back(six);
            JointDescription free = six;
            free.angular[(axis + 1) % 3] = JointRange{-0.5, 0.5};
            moved.push_back(free);
        }
    }
    for (std::size_t i = 0; i < moved.size(); ++i) {
        Rail rail({});
        moved[i].kind = i % 13 == 0 ? JointKind::Slider : JointKind::SixAxes;
        rail.world.step(tick);
        rail.join(moved[i]);
        const bool turns = i % 13 != 0 && (i % 13 - 1) / 2 >= 3;
        const double most = turns ? 1.1 : 0.11;
        Pose before = rail.world.pose(rail.id);
        for (int step = 0; step < 1000; ++step) {
            rail.world.step(tick);
            const Pose now = rail.world.pose(rail.id);
            const Vec3 way = turns ? turn_vector(now.rotation * glm::conjugate(before.rotation))
                                   : now.position - before.position;
            const Vec3 told =
                turns ? rail.world.angular_velocity(rail.id) : rail.world.linear_velocity(rail.id);
            ASSERT_LE(glm::length(way), most * tick) << "case " << i << ", step " << step;
            ASSERT_LE(glm::length(way / tick - told), 0.2 * most) << "case " << i << ", step " << step;
            before = now;
        }
        const double end = turns ? glm::length(turn_vector(before.rotation)) : glm::length(before.position);
        EXPECT_GT(end, to - (turns ? 2e-3 : 5e-4)) << "case " << i;
        EXPECT_LT(end, to + (turns ? 0.011 : 0.0015)) << "case " << i;  // it may coast on within the range
    }
}

TEST(JointDrive, WhatMakesNoSenseIsRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    JointDescription joint;
    joint.kind = JointKind::Hinge;
    for (const JointDrive& wrong :
         {JointDrive{.stiffness = -1.0}, JointDrive{.damping = nan}, JointDrive{.pitch = -0.1},
          JointDrive{.strength = nan}, JointDrive{.reach = -1.0}, JointDrive{.rest = nan}}) {
        joint.drive = wrong;
        EXPECT_NE(wrong_in(joint), "");
    }
    for (const JointKind kind : {JointKind::Pin, JointKind::SixAxes}) {
        joint.kind = kind;
        joint.drive = detents;
        EXPECT_NE(wrong_in(joint), "");
    }
}

}  // namespace
}  // namespace tactus::joint_test
