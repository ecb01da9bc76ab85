// Friction of faces that slide and turn at once (contact_points.hpp, contact_rules.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene.hpp"

namespace tactus::patch_friction_test {
namespace {

using namespace scene;

constexpr double g = 9.81;
constexpr double friction = 0.4;

Quat about_y(double angle) {
    return {std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0};
}

struct Slid {
    double way = 0.0;         // (unit: meters)
    double spin_time = 0.0;   // until 1 % is left (unit: seconds)
    double slide_time = 0.0;  // likewise
};

// A box that rests on the ground, turned by `heading`, is given a velocity along its own x and a spin.
Slid slide(const Vec3& size, double speed, double spin, double heading) {
    PhysicsWorld world;
    add(world, ground(friction));
    BodyDescription body = box(size, {0.0, 0.5 * size.y, 0.0}, 0.2, friction);
    body.pose.rotation = about_y(heading);
    const BodyId id = add(world, body);
    run(world, 100);
    const Vec3 start = world.center_of_mass(id);
    world.set_velocity(id, about_y(heading) * Vec3(speed, 0.0, 0.0), {0.0, spin, 0.0});
    Slid result;
    for (int i = 1; i <= 1000; ++i) {
        world.step(tick);
        if (std::abs(world.angular_velocity(id).y) > 0.01 * spin)
            result.spin_time = i * tick;
        if (glm::length(world.linear_velocity(id)) > 0.01 * speed)
            result.slide_time = i * tick;
    }
    result.way = glm::distance(world.center_of_mass(id), start);
    return result;
}

// Coulomb: v^2 / (2 mu g), whichever way the box and its velocity point.
TEST(PatchFriction, StopsABoxAlikeInEachDirection) {
    for (const double heading : {0.0, 0.2, 0.5, 0.785, 1.1, 2.0})
        EXPECT_NEAR(slide(Vec3(0.1), 1.5, 0.0, heading).way, 1.5 * 1.5 / (2.0 * friction * g), 0.004 * 0.287)
            << heading;
}

// The load lies at the corners, d = a / sqrt 2 from the middle: I w / (mu m g d), I = m a^2 / 6.
TEST(PatchFriction, StopsTheSpinOfASquare) {
    const double right = 0.99 * 20.0 * 0.1 * 0.1 / 6.0 / (friction * g * 0.05 * std::numbers::sqrt2);
    for (const double heading : {0.0, 0.3, 0.7})
        EXPECT_NEAR(slide({0.1, 0.02, 0.1}, 0.0, 20.0, heading).spin_time, right, 0.02 * right) << heading;
}

// Sliding and spinning, each of its corners is braked against its own velocity: both end together, and later
// than either alone (0.127 m and 0.119 s). Integrated for a square whose corners bear a quarter each.
TEST(PatchFriction, CouplesSlidingAndTurning) {
    const Slid both = slide({0.1, 0.02, 0.1}, 1.0, 20.0, 0.3);
    EXPECT_NEAR(both.way, 0.175, 0.03 * 0.175);
    EXPECT_NEAR(both.spin_time, 0.304, 0.05 * 0.304);
    EXPECT_NEAR(both.slide_time, both.spin_time, 0.02);
}

// A rod that a force of 0.6 mu m g pulls at its end turns about a point near the other one; 0.4 mu m g does
// not move it. It takes 0.5 mu m g where the load is at the ends.
TEST(PatchFriction, ARodTurnsWhereItIsPulledAtItsEnd) {
    constexpr double mass = 0.3;
    const auto turned = [](double share) {
        PhysicsWorld world;
        add(world, ground(friction));
        const BodyId id = add(world, box({0.3, 0.02, 0.02}, {0.0, 0.01, 0.0}, mass, friction));
        run(world, 100);
        for (int i = 0; i < 200; ++i) {
            const Pose pose = world.pose(id);
            const Vec3 across = pose.rotation * Vec3(0.0, 0.0, 1.0);
            world.apply_force(id, share * friction * mass * g * across,
                              pose.position + pose.rotation * Vec3(0.15, -0.01, 0.0));
            world.step(tick);
        }
        return std::abs(2.0 * std::asin(world.pose(id).rotation.y));
    };
    EXPECT_LT(turned(0.4), 1e-3);
    EXPECT_GT(turned(0.6), 0.05);
}

// On a slope below the angle of friction nothing creeps.
// In ten seconds it would leave its circle by 13 %.
TEST(PatchFriction, HoldsABoxOnATurntable) {
    PhysicsWorld world;
    BodyDescription table = box({1.0, 0.1, 1.0}, {0.0, -0.05, 0.0}, 1.0, 0.6);
    table.motion = Motion::Kinematic;
    const BodyId turns = add(world, table);
    const BodyId id = add(world, box(Vec3(0.04), {0.15, 0.02, 0.0}, 0.2, 0.6));
    run(world, 200);
    double turned = 0.0;
    for (int i = 0; i < 10'000; ++i) {
        const double rate = 5.0 * std::min(1.0, i / 1000.0);
        turned += rate * tick;
        world.set_velocity(turns, Vec3(0.0), {0.0, rate, 0.0});
        world.step(tick);
    }
    const Vec3 right = about_y(turned) * Vec3(0.15, 0.02, 0.0);
    EXPECT_NEAR(glm::distance(world.pose(id).position, right), 0.0, 1e-3);
    EXPECT_NEAR(std::hypot(world.pose(id).position.x, world.pose(id).position.z), 0.15, 1e-4);
}

TEST(PatchFriction, HoldsOnASlope) {
    PhysicsSettings settings;
    settings.gravity = g * Vec3(std::sin(0.3), -std::cos(0.3), 0.0);
    PhysicsWorld world(settings);
    add(world, ground(friction));
    BodyDescription body = box(Vec3(0.1), {0.0, 0.05, 0.0}, 0.2, friction);
    body.pose.rotation = about_y(0.4);
    body.can_sleep = false;
    const BodyId id = add(world, body);
    run(world, 200);
    const Vec3 before = world.pose(id).position;
    run(world, 5000);
    EXPECT_LT(glm::distance(world.pose(id).position, before), 2e-5);
}

// A pile of light boxes under a heavy one does not give way (contact_rules.hpp).
TEST(PatchFriction, LightBoxesBearAHeavyOne) {
    PhysicsWorld world;
    add(world, ground());
    BodyId top;
    for (int i = 0; i < 5; ++i)
        top = add(world, box({0.1, 0.05, 0.1}, {0.0, 0.05 * i + 0.025, 0.0}, i == 4 ? 50.0 : 0.5, 0.5));
    run(world, 3000);
    EXPECT_NEAR(world.pose(top).position.y, 0.225, 1e-3);
}

}  // namespace
}  // namespace tactus::patch_friction_test
