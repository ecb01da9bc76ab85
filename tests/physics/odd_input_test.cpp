// Whatever comes in: no crash, no value that is not a number, and a reason where something is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "physics/physics_world.hpp"
#include "scene.hpp"

namespace tactus::odd_input_test {
namespace {

using namespace scene;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const std::vector<double> odd_numbers{nan,  infinity, -infinity, 1e300,   -1e300, 1e30, -1e30,
                                      1e12, 1e-12,    1e-300,    -1e-300, -1.0,   0.0};

bool is_sane(const PhysicsWorld& world, BodyId id) {
    const Pose pose = world.pose(id);
    const Vec3 sum = pose.position + world.linear_velocity(id) + world.angular_velocity(id) +
                     world.velocity_at(id, Vec3(1.0));
    return std::isfinite(sum.x + sum.y + sum.z) && std::abs(glm::length(pose.rotation) - 1.0) < 1e-6;
}

struct Scene {
    explicit Scene(const PhysicsSettings& settings = {}) : world(settings) {
        add(world, ground());
        for (int i = 0; i < 4; ++i)
            ids.push_back(add(world, box(Vec3(0.1), {0.101 * i, 0.05, 0.0}, 0.5)));
        add(world, ball(0.05, {0.05, 0.16, 0.0}, 0.2));
    }

    void expect_sane(const std::string& what) {
        for (int i = 0; i < 50; ++i) {
            world.step(tick);
            for (const BodyId id : ids)
                ASSERT_TRUE(is_sane(world, id)) << what << ", " << i << " steps later";
        }
    }

    PhysicsWorld world;
    std::vector<BodyId> ids;
};

TEST(OddInput, DescriptionsAreRefusedWithAReasonOrMakeSoundBodies) {
    using Change = std::function<void(BodyDescription&, double)>;
    const std::vector<std::pair<const char*, Change>> changes{
        {"mass", [](BodyDescription& b, double v) { b.mass = v; }},
        {"inertia", [](BodyDescription& b, double v) { b.inertia = Vec3(v); }},
        {"one inertia", [](BodyDescription& b, double v) { b.inertia = Vec3(1e-3, 1e-3, v); }},
        {"centre", [](BodyDescription& b, double v) { b.center_of_mass = Vec3(0.0, v, 0.0); }},
        {"place", [](BodyDescription& b, double v) { b.pose.position.y = v; }},
        {"turn", [](BodyDescription& b, double v) { b.pose.rotation.y = v; }},
        {"place of shape", [](BodyDescription& b, double v) { b.shapes[0].pose.position.x = v; }},
        {"turn of shape", [](BodyDescription& b, double v) { b.shapes[0].pose.rotation.x = v; }},
        {"velocity", [](BodyDescription& b, double v) { b.linear_velocity.x = v; }},
        {"spin", [](BodyDescription& b, double v) { b.angular_velocity.z = v; }},
        {"friction", [](BodyDescription& b, double v) { b.material.friction = v; }},
        {"bounce", [](BodyDescription& b, double v) { b.material.restitution = v; }},
        {"damping", [](BodyDescription& b, double v) { b.linear_damping = v; }},
        {"spin damping", [](BodyDescription& b, double v) { b.angular_damping = v; }},
        {"gravity scale", [](BodyDescription& b, double v) { b.gravity_scale = v; }},
        {"box", [](BodyDescription& b, double v) { b.shapes[0].shape = BoxShape{{0.05, v, 0.05}}; }},
        {"ball", [](BodyDescription& b, double v) { b.shapes[0].shape = SphereShape{v}; }},
        {"capsule", [](BodyDescription& b, double v) { b.shapes[0].shape = CapsuleShape{0.05, v}; }},
        {"cylinder", [](BodyDescription& b, double v) { b.shapes[0].shape = CylinderShape{v, 0.05}; }},
        {"hull", [](BodyDescription& b, double v) { b.shapes[0].shape = ConvexHullShape{cube_mesh(v)}; }},
        {"mesh", [](BodyDescription& b, double v) { b.shapes[0].shape = MeshShape{cube_mesh(v)}; }}};
    for (const auto& [name, change] : changes)
        for (const double value : odd_numbers) {
            const std::string what = std::string(name) + " = " + std::to_string(value);
            BodyDescription description = box(Vec3(0.1), {0.1, 0.15, 0.0}, 0.5);
            change(description, value);
            PreparedBody body = prepare(description);
            ASSERT_NE(body.ready(), !body.error().empty()) << what;
            if (!body.ready())
                continue;
            Scene scene;
            scene.ids.push_back(scene.world.add(body));
            ASSERT_TRUE(scene.ids.back().valid()) << what;
            scene.expect_sane(what);
        }
}

TEST(OddInput, ChangesLeaveEverythingSound) {
    using Change = std::function<void(PhysicsWorld&, BodyId, double)>;
    const Quat upright{1.0, 0.0, 0.0, 0.0};
    const std::vector<std::pair<const char*, Change>> changes{
        {"gravity", [](PhysicsWorld& w, BodyId, double v) { w.set_gravity({0.0, v, 0.0}); }},
        {"place", [&](PhysicsWorld& w, BodyId id, double v) { w.set_pose(id, {{0.0, v, 0.0}, upright}); }},
        {"turn", [](PhysicsWorld& w, BodyId id,
                    double v) { w.set_pose(id, {{0.0, 0.05, 0.0}, Quat(v, 0.0, 0.0, 0.0)}); }},
        {"way",
         [&](PhysicsWorld& w, BodyId id, double v) { w.move_to(id, {{v, 0.05, 0.0}, upright}, tick); }},
        {"turning way", [](PhysicsWorld& w, BodyId id,
                           double v) { w.move_to(id, {Vec3(0.0), Quat(0.0, v, 0.0, 0.0)}, tick); }},
        {"time of a way",
         [&](PhysicsWorld& w, BodyId id, double v) { w.move_to(id, {Vec3(0.0), upright}, v); }},
        {"velocity",
         [](PhysicsWorld& w, BodyId id, double v) { w.set_velocity(id, {v, 0.0, 0.0}, Vec3(0.0)); }},
        {"spin", [](PhysicsWorld& w, BodyId id, double v) { w.set_velocity(id, Vec3(0.0), Vec3(v)); }},
        {"friction", [](PhysicsWorld& w, BodyId id, double v) { w.set_material(id, {v, 0.0}); }},
        {"bounce", [](PhysicsWorld& w, BodyId id, double v) { w.set_material(id, {0.5, v}); }},
        {"damping", [](PhysicsWorld& w, BodyId id, double v) { w.set_damping(id, v, v); }},
        {"gravity scale", [](PhysicsWorld& w, BodyId id, double v) { w.set_gravity_scale(id, v); }},
        {"force", [](PhysicsWorld& w, BodyId id, double v) { w.apply_force(id, {v, v, 0.0}, Vec3(0.1)); }},
        {"place of a force",
         [](PhysicsWorld& w, BodyId id, double v) { w.apply_force(id, {1.0, 0.0, 0.0}, Vec3(v)); }},
        {"torque", [](PhysicsWorld& w, BodyId id, double v) { w.apply_torque(id, Vec3(v)); }},
        {"spring's force", [](PhysicsWorld& w, BodyId id,
                              double v) { w.apply_spring_force(id, {{v, 0.0, 0.0}, Vec3(0.1), 1e3}); }},
        {"spring's place", [](PhysicsWorld& w, BodyId id,
                              double v) { w.apply_spring_force(id, {{1.0, 0.0, 0.0}, Vec3(v), 1e3}); }},
        {"spring's stiffness",
         [](PhysicsWorld& w, BodyId id, double v) { w.apply_spring_force(id, {Vec3(1.0), Vec3(0.1), v}); }},
        {"spring's damping", [](PhysicsWorld& w, BodyId id,
                                double v) { w.apply_spring_force(id, {Vec3(1.0), Vec3(0.1), 1e3, v}); }},
        {"hand's velocity", [](PhysicsWorld& w, BodyId id, double v) {
             w.apply_spring_force(id, {Vec3(1.0), Vec3(0.1), 1e3, 0.0, Vec3(v), true});
         }}};
    for (const auto& [name, change] : changes)
        for (const double value : odd_numbers) {
            Scene scene;
            run(scene.world, 20);
            for (const BodyId id : scene.ids)
                change(scene.world, id, value);
            scene.expect_sane(std::string(name) + " = " + std::to_string(value));
        }
}

TEST(OddInput, JointsAreRefusedOrHold) {
    using Change = std::function<void(JointDescription&, double)>;
    const std::vector<std::pair<const char*, Change>> changes{
        {"place", [](JointDescription& j, double v) { j.frame.position.x = v; }},
        {"turn", [](JointDescription& j, double v) { j.frame.rotation.x = v; }},
        {"way", [](JointDescription& j, double v) { j.linear[0] = {-1.0, v}; }},
        {"way from", [](JointDescription& j, double v) { j.linear[0] = {v, 1.0}; }},
        {"angle", [](JointDescription& j, double v) { j.angular[2] = {-1.0, v}; }},
        {"speed", [](JointDescription& j, double v) { j.motor_speed = v, j.motor_torque = 1.0; }},
        {"torque", [](JointDescription& j, double v) { j.motor_speed = 1.0, j.motor_torque = v; }}};
    for (const JointKind kind : {JointKind::Pin, JointKind::Hinge, JointKind::Slider, JointKind::SixAxes})
        for (const auto& [name, change] : changes)
            for (const double value : odd_numbers) {
                JointDescription joint;
                joint.kind = kind;
                change(joint, value);
                if (!wrong_in(joint).empty())
                    continue;
                Scene scene;
                ASSERT_TRUE(scene.world.add_joint(joint, scene.ids[0], scene.ids[1]).valid());
                scene.expect_sane(std::string(name) + " = " + std::to_string(value) + " of kind " +
                                  std::to_string(static_cast<int>(kind)));
            }
}

TEST(OddInput, ManyBodiesInOnePlaceComeApart) {
    PhysicsWorld world;
    add(world, ground());
    std::vector<BodyId> ids;
    for (int i = 0; i < 60; ++i)
        ids.push_back(add(
            world, i % 2 == 0 ? box(Vec3(0.1), {0.0, 0.05, 0.0}, 0.5) : ball(0.05, {0.0, 0.05, 0.0}, 0.3)));
    run(world, 3000);
    for (const BodyId id : ids) {
        ASSERT_TRUE(is_sane(world, id));
        EXPECT_GT(world.pose(id).position.y, -0.01);
        EXPECT_LT(glm::length(world.pose(id).position), 5.0);
    }
}

TEST(OddInput, TenKilometresAwayABoxRestsAsItDoesHere) {
    const Vec3 far{1e4, 0.0, -1e4};
    PhysicsWorld world;
    add(world, ground());
    BodyDescription floor = box({1.0, 0.2, 1.0}, far - Vec3(0.0, 0.1, 0.0), 1.0);
    floor.motion = Motion::Static;
    add(world, floor);
    const BodyId id = add(world, box(Vec3(0.1), far + Vec3(0.0, 0.051, 0.0), 0.5));
    run(world, 1000);
    EXPECT_NEAR(world.pose(id).position.y, 0.05, 1e-4);
    EXPECT_NEAR(world.pose(id).position.x, 1e4, 1e-4);
    EXPECT_FALSE(world.awake(id));
}

TEST(OddInput, WithoutGravityAndUnderAHundredTimesIt) {
    for (const double gravity : {0.0, -1000.0}) {
        PhysicsSettings settings;
        settings.gravity = {0.0, gravity, 0.0};
        Scene scene(settings);
        scene.expect_sane("gravity " + std::to_string(gravity));
        for (const BodyId id : scene.ids)
            EXPECT_NEAR(scene.world.pose(id).position.y, 0.05, 1e-3) << gravity;
    }
}

TEST(OddInput, AThousandTimesTheMassOnTop) {
    PhysicsWorld world;
    add(world, ground());
    const BodyId low = add(world, box(Vec3(0.1), {0.0, 0.05, 0.0}, 0.01));
    const BodyId high = add(world, box(Vec3(0.1), {0.0, 0.15, 0.0}, 10.0));
    run(world, 2000);
    EXPECT_NEAR(world.pose(low).position.y, 0.05, 2e-3);
    EXPECT_NEAR(world.pose(high).position.y, 0.15, 4e-3);
}

// Joined bodies that are torn a thousand kilometres apart: what a solver in single precision makes of it is
// not seen, and whoever is not joined to them does not notice.
TEST(OddInput, ATornJointLosesNobody) {
    for (const JointKind kind : {JointKind::Pin, JointKind::Hinge, JointKind::Slider, JointKind::SixAxes}) {
        Scene scene;
        run(scene.world, 100);
        JointDescription joint;
        joint.kind = kind;
        ASSERT_TRUE(scene.world.add_joint(joint, scene.ids[0], scene.ids[1]).valid());
        scene.world.set_pose(scene.ids[0], {{3e6, 1e6, -2e6}, Quat(1.0, 0.0, 0.0, 0.0)});
        scene.expect_sane("joint of kind " + std::to_string(static_cast<int>(kind)));
        EXPECT_NEAR(scene.world.pose(scene.ids[3]).position.y, 0.05, 1e-3);
    }
}

TEST(OddInput, WhatFallsForEverIsPutToRestAtTheEndOfTheWorldAndSaidSo) {
    PhysicsWorld world;
    const BodyId id = add(world, ball(0.05, {0.0, -9.9999e6, 0.0}, 1.0));
    world.set_velocity(id, {0.0, -1e4, 0.0}, Vec3(0.0));
    std::uint32_t status = step_ok;
    for (int i = 0; i < 200; ++i)
        status |= world.step(tick);
    EXPECT_NE(status & step_body_lost, 0u);
    EXPECT_FALSE(world.awake(id));
    EXPECT_NEAR(world.pose(id).position.y, -1e7, 20.0);
    EXPECT_EQ(world.linear_velocity(id), Vec3(0.0));
    EXPECT_EQ(world.step(tick), step_nothing_awake);
}

TEST(OddInput, ABodyThatIsPutToSleepAfterASpringPushedItStaysAsleep) {
    PhysicsWorld world;
    add(world, ground());
    const BodyId pushed = add(world, box(Vec3(0.1), {0.0, 0.5, 0.0}, 0.5));
    const BodyId awake = add(world, box(Vec3(0.1), {1.0, 0.5, 0.0}, 0.5));
    world.step(tick);
    world.apply_spring_force(pushed, {{3.0, 0.0, 0.0}, {0.0, 0.5, 0.0}, 1e3, 0.0, {}, true});
    world.sleep(pushed);
    const Pose before = world.pose(pushed);
    for (int i = 0; i < 10; ++i)
        world.step(tick);
    EXPECT_FALSE(world.awake(pushed));
    EXPECT_EQ(world.pose(pushed).position, before.position);
    EXPECT_TRUE(world.awake(awake));
}

// Anything, in any order, thousands of times.
void call_at_random(unsigned seed) {
    std::mt19937 random(seed);
    const auto pick = [&random](std::size_t count) { return static_cast<std::size_t>(random() % count); };
    const auto number = [&] {
        return random() % 8 == 0 ? odd_numbers[pick(odd_numbers.size())]
                                 : 1e-3 * static_cast<double>(random() % 2000) - 1.0;
    };
    const auto vector = [&] {
        const double x = number(), y = number();
        return Vec3(x, y, number());
    };
    PhysicsSettings settings;
    settings.max_bodies = 40;
    settings.max_joints = 8;
    settings.full_rate_bodies = 12;
    settings.max_touching_pairs = 64;
    settings.max_contacts = 64;
    PhysicsWorld world(settings);
    add(world, ground());
    std::vector<BodyId> ids;
    std::vector<JointId> joints;
    std::vector<PreparedBody> out;
    const auto any = [&] { return ids.empty() || pick(20) == 0 ? BodyId{3} : ids[pick(ids.size())]; };
    for (int i = 0; i < 20'000; ++i) {
        const BodyId id = any();
        const BodyId other = any();
        switch (pick(18)) {
            case 0: {
                BodyDescription description = box(Vec3(0.1), 0.3 * vector(), 0.5);
                description.may_move = true;
                description.motion = static_cast<Motion>(pick(3));
                PreparedBody body = prepare(description);
                if (const BodyId added = world.add(body); added.valid())
                    ids.push_back(added);
                break;
            }
            case 1:
                out.push_back(world.remove(id));
                std::erase(ids, id);
                break;
            case 2:
                world.set_pose(id, {vector(), Quat(number(), number(), 0.0, number())});
                break;
            case 3:
                world.set_velocity(id, vector(), vector());
                break;
            case 4:
                world.apply_force(id, vector(), vector());
                break;
            case 5:
                world.apply_spring_force(id, {vector(), vector(), 1e3 * number(), number(), vector(), true});
                break;
            case 6:
                world.apply_torque(id, vector());
                break;
            case 7:
                world.set_motion(id, static_cast<Motion>(pick(3)));
                break;
            case 8: {
                JointDescription joint;
                joint.kind = static_cast<JointKind>(pick(4));
                joint.frame.position = vector();
                joint.linear[pick(3)] = {number(), number()};
                joint.angular[pick(3)] = {number(), number()};
                if (wrong_in(joint).empty())
                    joints.push_back(world.add_joint(joint, id, pick(3) == 0 ? BodyId{} : other));
                break;
            }
            case 9:
                if (!joints.empty())
                    world.remove_joint(joints[pick(joints.size())]);
                break;
            case 10:
                world.set_collision(
                    id, {static_cast<std::uint32_t>(pick(4)), static_cast<std::uint32_t>(pick(4))});
                break;
            case 11:
                world.set_material(id, {number(), number(), pick(2) == 0, pick(2) == 0});
                break;
            case 12:
                world.sleep(id);
                break;
            case 13:
                world.wake(id);
                break;
            case 14:
                world.move_to(id, {vector(), Quat(1.0, 0.0, 0.0, 0.0)}, tick);
                break;
            case 15:
                world.set_gravity({number(), -9.81, 0.0});
                break;
            case 16: {
                PreparedBody shape = prepare(ball(0.03, Vec3(0.0), 0.2));
                world.reshape(id, shape);
                break;
            }
            default:
                world.set_hands(std::vector<Vec3>{vector()});
                break;
        }
        if (i % 2 == 0)
            world.step(tick);
        for (const BodyId each : ids)
            ASSERT_TRUE(is_sane(world, each)) << "seed " << seed << ", call " << i;
    }
}

TEST(OddInput, RandomCallsBreakNothing) {
    for (unsigned seed = 1; seed <= 40 && !HasFatalFailure(); ++seed)
        call_at_random(seed);
}

}  // namespace
}  // namespace tactus::odd_input_test
