// Bodies that spin without a torque (free_spin.hpp), and what swings about joints (joint_swing.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene.hpp"

namespace tactus::free_spin_test {
namespace {

using namespace scene;

struct Spinning {
    Spinning(const Vec3& velocity, const Vec3& edges = {0.04, 0.08, 0.12}) : world(weightless()) {
        constexpr double mass = 0.5;
        moments = mass / 12.0 *
                  Vec3(edges.y * edges.y + edges.z * edges.z, edges.x * edges.x + edges.z * edges.z,
                       edges.x * edges.x + edges.y * edges.y);
        BodyDescription body = box(edges, Vec3(0.0), mass);
        body.angular_velocity = velocity;
        body.can_sleep = false;
        id = add(world, body);
    }
    static PhysicsSettings weightless() {
        PhysicsSettings settings;
        settings.gravity = Vec3(0.0);
        return settings;
    }
    Vec3 local_velocity() const {
        return glm::conjugate(world.pose(id).rotation) * world.angular_velocity(id);
    }
    Vec3 momentum() const { return world.pose(id).rotation * (moments * local_velocity()); }
    double energy() const { return 0.5 * glm::dot(local_velocity(), moments * local_velocity()); }

    PhysicsWorld world;
    BodyId id;
    Vec3 moments{0.0};
};

TEST(FreeSpin, KeepsItsMomentumAndItsEnergy) {
    for (const Vec3& velocity : {Vec3(3.0, 4.0, 5.0), Vec3(0.1, 30.0, 0.0), Vec3(300.0, 400.0, 500.0)}) {
        Spinning body(velocity);
        const Vec3 momentum = body.momentum();
        const double energy = body.energy();
        for (int i = 0; i < 10'000; ++i) {
            body.world.step(tick);
            ASSERT_LT(glm::distance(body.momentum(), momentum), 1e-4 * glm::length(momentum)) << i;
            ASSERT_NEAR(body.energy(), energy, 2e-3 * energy) << i;
        }
    }
}

// About its middle axis a box flips again and again, here each 1.315 s twice over (bench `credibility` has
// the closed form).
TEST(FreeSpin, FlipsAboutItsMiddleAxis) {
    Spinning body({0.05, 10.0, 0.0});
    int flips = 0;
    double before = 10.0;
    for (int i = 0; i < 10'000; ++i) {
        body.world.step(tick);
        const double now = body.local_velocity().y;
        flips += now * before < 0.0 ? 1 : 0;
        before = now;
    }
    EXPECT_EQ(flips, 4);  // at 1.3, 3.9, 6.6 and 9.2 s
}

// Of a spin that is far too fast for the step, of needles and sheets.
TEST(FreeSpin, NoSpinGainsEnergy) {
    for (const Vec3& edges : {Vec3(0.001, 0.001, 0.3), Vec3(0.3, 0.0005, 0.2), Vec3(0.1, 0.2, 0.3)})
        for (const Vec3& velocity : {Vec3(1900.0, 300.0, 100.0), Vec3(10.0, 1000.0, 1000.0)}) {
            Spinning body(velocity, edges);
            const Vec3 momentum = body.momentum();
            const double most = 0.5 * glm::dot(momentum, momentum) /
                                std::min({body.moments.x, body.moments.y, body.moments.z});
            for (int i = 0; i < 2'000; ++i) {
                body.world.step(tick);
                ASSERT_LT(body.energy(), 1.001 * most) << i;
                ASSERT_LT(glm::length(body.momentum()), 1.01 * glm::length(momentum)) << i;
            }
        }
}

// w^2 dt m r^2 / (m r^2 + I) of its energy a second went with 20 rad/s: 98 % in ten seconds.
TEST(JointSwing, ADoorIsNotBraked) {
    PhysicsWorld world(Spinning::weightless());
    BodyDescription door = box({0.8, 2.0, 0.04}, {0.4, 0.0, 0.0}, 20.0);
    door.angular_velocity = {0.0, 20.0, 0.0};
    door.linear_velocity = {0.0, 0.0, -8.0};
    door.can_sleep = false;
    const BodyId id = add(world, door);
    JointDescription hinge;
    hinge.kind = JointKind::Hinge;
    hinge.frame.rotation = Quat(std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0);
    hinge.angular[2] = JointRange::free();
    world.add_joint(hinge, id, BodyId{});
    run(world, 10'000);
    EXPECT_NEAR(world.angular_velocity(id).y, 20.0, 0.02);
}

// Two rods of a chain that flies freely: what their pin does leaves momentum and energy as they are.
TEST(JointSwing, AFreeChainKeepsItsMomentumAndItsEnergy) {
    PhysicsWorld world(Spinning::weightless());
    const auto rod = [&](double x, const Vec3& linear, const Vec3& angular) {
        BodyDescription body = box({0.2, 0.02, 0.02}, {x, 0.0, 0.0}, 0.1);
        body.linear_velocity = linear;
        body.angular_velocity = angular;
        body.can_sleep = false;
        return add(world, body);
    };
    // The pin between them moves with neither: v = w x r on both sides.
    const BodyId first = rod(-0.1, {0.0, -1.0, 0.0}, {0.0, 0.0, 10.0});
    const BodyId second = rod(0.1, {0.0, -0.5, 0.0}, {0.0, 0.0, -5.0});
    JointDescription pin;
    pin.kind = JointKind::Pin;
    world.add_joint(pin, first, second);
    const double across = 0.1 / 12.0 * (0.2 * 0.2 + 0.02 * 0.02);
    const auto energy = [&] {
        double sum = 0.0;
        for (const BodyId id : {first, second}) {
            const Vec3 v = world.linear_velocity(id);
            const double w = world.angular_velocity(id).z;
            sum += 0.5 * 0.1 * glm::dot(v, v) + 0.5 * across * w * w;
        }
        return sum;
    };
    const double before = energy();
    run(world, 5'000);
    EXPECT_NEAR(energy(), before, 0.01 * before);
    EXPECT_LT(glm::distance(world.linear_velocity(first) + world.linear_velocity(second), {0.0, -1.5, 0.0}),
              1e-4);
}

// v / c, at every step.
TEST(Damping, ABodyStopsAfterVOverC) {
    for (const double damping : {1.0, 10.0, 100.0, 1000.0}) {
        PhysicsWorld world(Spinning::weightless());
        BodyDescription body = ball(0.02, Vec3(0.0), 0.1);
        body.linear_damping = damping;
        body.linear_velocity = {1.0, 0.0, 0.0};
        body.can_sleep = false;
        const BodyId id = add(world, body);
        run(world, static_cast<int>(20.0 / damping / tick) + 20);
        EXPECT_NEAR(world.center_of_mass(id).x, 1.0 / damping, 1e-4 / damping) << damping;
    }
}

}  // namespace
}  // namespace tactus::free_spin_test
