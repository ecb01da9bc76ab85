// Bodies that roll: contacts that are kept from step to step do not drive them (world_state.cpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "scene.hpp"

namespace tactus::rolling_test {
namespace {

using namespace scene;

// A cylinder of mass m and radius r, whose axis lies along z.
BodyDescription wheel(double radius, const Vec3& position, double mass) {
    BodyDescription body = ball(radius, position, mass);
    body.shapes = one(CylinderShape{radius, 0.3 * radius});
    body.pose.rotation = glm::angleAxis(0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0));
    return body;
}

// Nothing drives or brakes it: it keeps its speed, however slow it is.
TEST(Rolling, KeepsItsSpeedOnALevelFloor) {
    for (const double radius : {0.005, 0.03})
        for (const bool is_ball : {true, false})
            for (const double speed : {0.004, 0.03, 0.08, 0.5}) {
                const Vec3 at(0.0, radius, 0.0);
                PhysicsWorld world;
                add(world, ground());
                const BodyId id = add(world, is_ball ? ball(radius, at, 0.1) : wheel(radius, at, 0.1));
                run(world, 50);
                world.set_velocity(id, {speed, 0.0, 0.0}, {0.0, 0.0, -speed / radius});
                run(world, 2000);
                EXPECT_NEAR(world.linear_velocity(id).x, speed, 0.002 * speed)
                    << (is_ball ? "ball" : "wheel") << " of " << radius << " m";
            }
}

// A force F at the chassis moves all masses and turns the wheels: a = F / (m + 4 I / r^2), I = m_w r^2 / 2.
TEST(Rolling, ACartOnFourWheelsGoesAsFastAsItsMassSays) {
    constexpr double chassis_mass = 0.4, wheel_mass = 0.3, radius = 0.03, seconds = 0.5;
    for (const double force : {0.1, 0.5, 2.0}) {
        PhysicsWorld world;
        add(world, ground());
        const BodyId chassis = add(world, box({0.2, 0.04, 0.1}, {0.0, 0.05, 0.0}, chassis_mass));
        for (const auto& [x, z] : std::array{std::array{-0.08, -0.07}, std::array{0.08, -0.07},
                                             std::array{-0.08, 0.07}, std::array{0.08, 0.07}}) {
            JointDescription hinge;
            hinge.kind = JointKind::Hinge;
            hinge.frame.position = {x, radius, z};
            hinge.angular[2] = JointRange::free();
            const BodyId turning = add(world, wheel(radius, hinge.frame.position, wheel_mass));
            ASSERT_TRUE(world.add_joint(hinge, chassis, turning).valid());
        }
        run(world, 300);
        const double before = world.linear_velocity(chassis).x;
        for (double time = 0.0; time < seconds - 0.5 * tick; time += tick) {
            world.apply_force(chassis, {force, 0.0, 0.0}, world.center_of_mass(chassis));
            world.step(tick);
        }
        const double right = force * seconds / (chassis_mass + 4.0 * 1.5 * wheel_mass);
        EXPECT_NEAR(world.linear_velocity(chassis).x - before, right, 0.01 * right) << force << " N";
    }
}

// A box of half height h rocks on a cylinder of radius R that does not turn: w^2 = m g (R - h) / (I + m h^2).
TEST(Rolling, ABoxOnARoundBodyRocksNoFartherAndAtItsPeriod) {
    constexpr double radius = 0.1, half_height = 0.05, half_width = 0.1, angle = 0.1;
    PhysicsWorld world;
    BodyDescription round = wheel(radius, {0.0, -radius, 0.0}, 1.0);
    round.shapes = one(CylinderShape{radius, 0.2});
    round.motion = Motion::Static;
    add(world, round);
    const Vec3 normal(std::sin(angle), std::cos(angle), 0.0);
    const Vec3 along(normal.y, -normal.x, 0.0);
    BodyDescription rocking = box({2.0 * half_width, 2.0 * half_height, 0.1}, Vec3(0.0), 0.5);
    rocking.pose.position =
        Vec3(0.0, -radius, 0.0) + (radius + half_height) * normal - radius * angle * along;
    rocking.pose.rotation = glm::angleAxis(-angle, Vec3(0.0, 0.0, 1.0));
    rocking.can_sleep = false;
    const BodyId id = add(world, rocking);
    double before = angle, most = 0.0, first = 0.0, last = 0.0;
    int crossings = 0;
    for (int i = 0; i < 10'000; ++i) {
        world.step(tick);
        const Quat turned = world.pose(id).rotation;
        const double now = -2.0 * std::atan2(turned.z, turned.w);
        if (before * now < 0.0) {
            (crossings++ == 0 ? first : last) = i * tick;
            most = 0.0;
        }
        most = std::max(most, std::abs(now));
        before = now;
    }
    const double moment = (half_width * half_width + half_height * half_height) / 3.0;
    const double right = 2.0 * std::numbers::pi *
                         std::sqrt((moment + half_height * half_height) / (9.81 * (radius - half_height)));
    EXPECT_NEAR(2.0 * (last - first) / (crossings - 1), right, 0.01 * right);
    EXPECT_NEAR(most, angle, 0.02 * angle);
}

// Cans on each other tremble, and turn a little. Their contacts are kept as those of boxes are.
TEST(Rolling, CansThatStandOnEachOtherKeepStanding) {
    for (const double radius : {0.01, 0.03}) {
        PhysicsWorld world;
        add(world, ground());
        BodyId top;
        for (int i = 0; i < 10; ++i) {
            BodyDescription can = ball(radius, {0.0, 2.0 * radius * (i + 0.5), 0.0}, 0.3);
            can.shapes = one(CylinderShape{radius, radius});
            can.can_sleep = false;
            top = add(world, can);
        }
        run(world, 10'000);
        EXPECT_GT(world.center_of_mass(top).y, 2.0 * radius * 9.4) << radius;
    }
}

}  // namespace
}  // namespace tactus::rolling_test
