#include "shared/physics_checks.hpp"

#include <algorithm>
#include <cmath>

#include "physics/physics_world.hpp"
#include "platform/clock.hpp"
#include "shared/bodies.hpp"

namespace tactus::shared {

namespace {

constexpr double gravity = 9.81;  // (unit: meters per square second)

double percent_off(double value, double exact) {
    return 100.0 * std::abs(value - exact) / std::abs(exact);
}

int steps_of(double seconds, double step) {
    return static_cast<int>(std::lround(seconds / step));
}

// One that never sleeps.
BodyDescription awake_box(const Vec3& size, const Vec3& position, double mass, double friction) {
    BodyDescription body = box(size, position, mass, friction);
    body.can_sleep = false;
    return body;
}

BodyId add(PhysicsWorld& world, const BodyDescription& description) {
    PreparedBody body = prepare(description);
    return world.add(body);
}

void run(PhysicsWorld& world, double seconds, double step) {
    for (int i = 0; i < steps_of(seconds, step); ++i) {
        world.step(step);
    }
}

// As small as the scenes: Jolt empties its tables of contacts in every step.
PhysicsSettings small() {
    PhysicsSettings settings;
    settings.max_bodies = 16;
    settings.max_touching_pairs = 64;
    settings.max_contacts = 64;
    return settings;
}

void fall(double step, PhysicsCheck& check) {
    PhysicsWorld world(small());
    const BodyId id = add(world, awake_box(Vec3(0.1), {0.0, 10.0, 0.0}, 1.0, 0.0));
    run(world, 1.0, step);
    check.fall = percent_off(10.0 - world.pose(id).position.y, 0.5 * gravity);
}

void slide(double step, PhysicsCheck& check) {
    constexpr double speed = 1.5;
    constexpr double friction = 0.3;
    constexpr double seconds = 1.0;
    PhysicsWorld world(small());
    add(world, ground(0.5));
    const BodyId id = add(world, awake_box({0.2, 0.1, 0.2}, {0.0, 0.05, 0.0}, 1.0, friction));
    run(world, 0.2, step);
    world.set_velocity(id, {speed, 0.0, 0.0}, Vec3(0.0));
    const double start = world.pose(id).position.x;
    const Nanoseconds before = monotonic_now();
    run(world, seconds, step);
    check.run_time = to_seconds(monotonic_now() - before) / seconds;
    check.sliding =
        percent_off(world.pose(id).position.x - start, speed * speed / (2.0 * friction * gravity));
}

void push(double step, PhysicsCheck& check) {
    // No sums of these are exact in binary.
    constexpr double force = 5.3;
    constexpr double mass = 1.7;
    constexpr double seconds = 0.5;
    PhysicsWorld world(small());
    add(world, ground(0.0));
    const BodyId id = add(world, awake_box(Vec3(0.15), {0.0, 0.075, 0.0}, mass, 0.0));
    for (int i = 0; i < steps_of(seconds, step); ++i) {
        world.apply_force(id, {force, 0.0, 0.0}, world.center_of_mass(id));
        world.step(step);
    }
    const double momentum = force * seconds;
    const double energy = momentum * momentum / (2.0 * mass);
    const double speed = world.linear_velocity(id).x;
    check.momentum = percent_off(mass * speed, momentum);
    check.energy = percent_off(0.5 * mass * speed * speed, energy);
    check.work = percent_off(force * world.pose(id).position.x, energy);
}

// A box over ice and a hand that stands still `depth` within where its face is at first, or as far before
// it: the share of the energy that is there at first which the box does not have when it has left the hand.
double spring_loss(double step, double stiffness, double mass, double depth, double speed) {
    PhysicsWorld world(small());
    add(world, ground(0.0));
    const BodyId id = add(world, awake_box(Vec3(0.15), {0.0, 0.075, 0.0}, mass, 0.0));
    world.set_velocity(id, {speed, 0.0, 0.0}, Vec3(0.0));
    for (int i = 0; i < steps_of(1.0, step); ++i) {
        const Vec3 at = world.pose(id).position;
        const double left = depth - at.x;
        if (left > 0.0) {
            world.apply_spring_force(id,
                                     {{stiffness * left, 0.0, 0.0}, at - Vec3(0.075, 0.0, 0.0), stiffness});
        }
        world.step(step);
    }
    const double given = mass * speed * speed + (depth > 0.0 ? stiffness * depth * depth : 0.0);
    const double end = world.linear_velocity(id).x;
    return 100.0 * (1.0 - mass * end * end / given);
}

void spring(double step, PhysicsCheck& check) {
    check.thrown = spring_loss(step, 100.0, 1.0, 0.02, 0.0);
    check.bounced = spring_loss(step, 100.0, 1.0, -0.01, -0.1);
    check.spring_loss = std::max(std::abs(check.thrown), std::abs(check.bounced));
}

}  // namespace

PhysicsCheck check_physics(double step) {
    PhysicsCheck check;
    fall(step, check);
    slide(step, check);
    push(step, check);
    spring(step, check);
    return check;
}

}  // namespace tactus::shared
