// Bodies that swing about a hinge, and bodies that are damped.
#include <vector>

#include "credibility/cases.hpp"

namespace tactus::bench {

namespace {

// A door, hinged at its edge, turns about the vertical without friction: nothing brakes it.
double door(double spin) {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    PhysicsWorld world(settings);
    BodyDescription body = shared::box({0.8, 2.0, 0.04}, {0.4, 0.0, 0.0}, 20.0);
    body.angular_velocity = {0.0, spin, 0.0};
    body.linear_velocity = {0.0, 0.0, -spin * 0.4};
    body.can_sleep = false;
    const BodyId id = enter(world, body);
    JointDescription hinge;
    hinge.kind = JointKind::Hinge;
    hinge.frame.rotation = Quat(std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0);
    hinge.angular[2] = JointRange::free();
    world.add_joint(hinge, id, BodyId{});
    run_until(world, 10.0, [](double) { return false; });
    return std::abs(std::pow(world.angular_velocity(id).y / spin, 2.0) - 1.0) * 100.0;
}

// A pendulum that is let go at the height of its hinge: the share of its energy that is lost, in percent.
double pendulum(double seconds) {
    constexpr double length = 0.5;
    constexpr double mass = 1.0;
    PhysicsWorld world;
    BodyDescription body = shared::box({length, 0.04, 0.04}, {0.5 * length, 0.0, 0.0}, mass);
    body.can_sleep = false;
    const BodyId id = enter(world, body);
    JointDescription hinge;
    hinge.kind = JointKind::Hinge;
    hinge.angular[2] = JointRange::free();
    world.add_joint(hinge, id, BodyId{});
    const double inertia = mass / 12.0 * (length * length + 0.04 * 0.04) + mass * 0.25 * length * length;
    double energy = 0.0;
    run_until(world, seconds, [&](double) {
        const double spin = world.angular_velocity(id).z;
        energy = 0.5 * inertia * spin * spin + mass * gravity * world.center_of_mass(id).y;
        return false;
    });
    // Above its lowest place.
    return std::abs(energy) / (mass * gravity * 0.5 * length) * 100.0;
}

// Way of a body that its damping alone stops: v / c.
double damped_way(double damping) {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    PhysicsWorld world(settings);
    BodyDescription body = shared::ball(0.02, Vec3(0.0), 0.1);
    body.linear_damping = damping;
    body.linear_velocity = {1.0, 0.0, 0.0};
    body.can_sleep = false;
    const BodyId id = enter(world, body);
    run_until(world, 20.0 / damping, [](double) { return false; });
    return world.center_of_mass(id).x;
}

// Newton's cradle of five balls in a row on ice: the last leaves as the first came.
double cradle() {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    PhysicsWorld world(settings);
    constexpr double radius = 0.02;
    std::vector<BodyId> balls;
    for (int i = 0; i < 5; ++i) {
        BodyDescription ball = shared::ball(radius, {2.0 * radius * i, 0.0, 0.0}, 0.1, 0.0);
        ball.material.restitution = 1.0;
        if (i == 0) {
            ball.pose.position.x -= 0.02;
            ball.linear_velocity.x = 0.8;
        }
        balls.push_back(enter(world, ball));
    }
    run_until(world, 0.1, [](double) { return false; });
    return world.linear_velocity(balls.back()).x;
}

}  // namespace

void measure_joints(Results& results) {
    const double slow = door(5.0);
    const double fast = door(20.0);
    results.add("door.energy_10s_5rad_s", slow);
    results.add("door.energy_10s_20rad_s", fast);
    results.add("door.energy_10s", std::max(slow, fast));
    results.add("pendulum90.energy_60s", pendulum(60.0));
    add_case(results, "damping.way_10", damped_way(10.0), 1.0 / 10.0);
    add_case(results, "damping.way_100", damped_way(100.0), 1.0 / 100.0);
    add_case(results, "cradle.speed", cradle(), 0.8);
}

}  // namespace tactus::bench
