// Masses, spins, shapes and crowds at the edge of what a world takes: all stays bounded, and nothing gains
// energy that it did not have.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "physics/physics_world.hpp"
#include "scene.hpp"
#include "shared/random_values.hpp"

namespace tactus::extreme_bodies_test {
namespace {

using namespace scene;

constexpr double gravity = 9.81;

struct Thing {
    BodyId id;
    double mass;
    Vec3 moments;  // about its own axes
};

Thing enter(PhysicsWorld& world, const BodyDescription& description, const Vec3& size) {
    const Vec3 squares = size * size;
    return {
        add(world, description), description.mass,
        description.mass / 12.0 * Vec3(squares.y + squares.z, squares.x + squares.z, squares.x + squares.y)};
}

Thing enter_box(PhysicsWorld& world, const Vec3& size, const Vec3& place, double mass) {
    BodyDescription body = box(size, place, mass);
    body.material.friction = 0.5;
    return enter(world, body, size);
}

Thing enter_ball(PhysicsWorld& world, double radius, const Vec3& place, double mass) {
    // A ball's 2/5 m r^2 is that of a cube of this edge.
    return enter(world, ball(radius, place, mass), Vec3(radius * std::sqrt(2.4)));
}

double kinetic(const PhysicsWorld& world, const Thing& thing) {
    const BodyMotion state = world.state(thing.id);
    const Vec3 spin = glm::conjugate(state.pose.rotation) * state.angular_velocity;
    return 0.5 * thing.mass * glm::dot(state.linear_velocity, state.linear_velocity) +
           0.5 * glm::dot(spin, thing.moments * spin);
}

double energy(const PhysicsWorld& world, const std::vector<Thing>& things) {
    double sum = 0.0;
    for (const Thing& thing : things)
        sum += kinetic(world, thing) + gravity * thing.mass * world.pose(thing.id).position.y;
    return sum;
}

// The most that the energy is above what it was at the start, in a number of ticks.
double most_gained(PhysicsWorld& world, const std::vector<Thing>& things, int ticks) {
    const double start = energy(world, things);
    double most = 0.0;
    for (int i = 0; i < ticks; ++i) {
        world.step(tick);
        const double now = energy(world, things);
        if (!std::isfinite(now))
            return now;
        most = std::max(most, now - start);
    }
    return most;
}

PhysicsWorld small_world(std::uint32_t max_bodies = 64) {
    PhysicsSettings settings;
    settings.max_bodies = max_bodies;
    return PhysicsWorld(settings);
}

TEST(ExtremeBodies, AMillionTimesTheMassOnTopGainsNothing) {
    for (const double ratio : {1e3, 1e6}) {
        PhysicsWorld world = small_world();
        add(world, ground());
        std::vector<Thing> things{enter_box(world, Vec3(0.1), {0.0, 0.05, 0.0}, 1e-3),
                                  enter_box(world, Vec3(0.1), {0.0, 0.151, 0.0}, 1e-3 * ratio)};
        const double heavy_falls = gravity * 1e-3 * ratio * 1e-3;
        EXPECT_LT(most_gained(world, things, 2000), 0.1 * heavy_falls) << ratio;
        EXPECT_GT(world.pose(things[1].id).position.y, 0.045) << ratio;
        EXPECT_GT(world.pose(things[0].id).position.y, 0.0) << ratio;
    }
}

TEST(ExtremeBodies, AMillionTimesTheMassThatRunsIntoSomethingLightThrowsItNoFasterThanTwice) {
    PhysicsWorld world = small_world();
    world.set_gravity(Vec3(0.0));
    BodyDescription heavy = ball(0.05, {-0.2, 0.0, 0.0}, 1e3);
    heavy.linear_velocity = {1.0, 0.0, 0.0};
    BodyDescription light = ball(0.05, Vec3(0.0), 1e-3);
    for (BodyDescription* body : {&heavy, &light}) {
        body->material.restitution = 0.5;
        body->can_sleep = false;
    }
    const BodyId runner = add(world, heavy);
    const BodyId target = add(world, light);
    run(world, 300);
    EXPECT_NEAR(world.linear_velocity(runner).x, 1.0, 1e-5);
    EXPECT_GE(world.linear_velocity(target).x, 1.99);
    EXPECT_LE(world.linear_velocity(target).x, 2.01);
}

TEST(ExtremeBodies, ASpinOfAThousandKeepsItsEnergyInTheAirAndLosesItOnTheFloor) {
    for (const Vec3& size :
         {Vec3(0.1), Vec3(0.02, 0.06, 0.1), Vec3(0.2, 0.002, 0.2), Vec3(0.004, 0.2, 0.004)}) {
        PhysicsWorld air = small_world();
        air.set_gravity(Vec3(0.0));
        std::vector<Thing> flying{enter_box(air, size, Vec3(0.0), 0.5)};
        air.set_velocity(flying[0].id, Vec3(0.0), {600.0, 500.0, 620.0});
        const double before = kinetic(air, flying[0]);
        run(air, 5000);
        EXPECT_NEAR(kinetic(air, flying[0]), before, 0.01 * before) << size.x << ' ' << size.y;

        PhysicsWorld floor = small_world();
        add(floor, ground());
        std::vector<Thing> landed{enter_box(floor, size, {0.0, 0.3, 0.0}, 0.5)};
        floor.set_velocity(landed[0].id, Vec3(0.0), {600.0, 500.0, 620.0});
        const double whole = energy(floor, landed);
        EXPECT_LT(most_gained(floor, landed, 3000), 0.01 * whole) << size.x << ' ' << size.y;
    }
}

// Its corners could give way without moving its middle, so that it sank.
TEST(ExtremeBodies, ABoxWithHardlyAnyInertiaStaysOnTheFloor) {
    for (const double share : {1e-2, 1e-3, 1e-4, 1e-6}) {
        PhysicsWorld world = small_world();
        add(world, ground());
        BodyDescription body = box(Vec3(0.1), {0.0, 0.06, 0.0}, 0.2);
        body.material.friction = 0.5;
        body.inertia = Vec3(share * 0.2 * 0.01 / 6.0);
        body.pose.rotation = glm::normalize(Quat(1.0, 0.02, 0.01, 0.03));
        const BodyId id = add(world, body);
        run(world, 3000);
        EXPECT_NEAR(world.center_of_mass(id).y, 0.05, 1e-4) << share;
        EXPECT_LT(glm::length(world.linear_velocity(id)), 2e-3) << share;
    }
}

// Twenty boxes that give back all of their approach speed, apart from one another at first. What is pressed
// into one another counts as too low or too high for a moment.
TEST(ExtremeBodies, ElasticBoxesGainNothing) {
    for (const double friction : {0.0, 0.5}) {
        for (const double edge : {0.04, 0.1}) {
            for (int seed = 0; seed < 3; ++seed) {
                PhysicsWorld world = small_world();
                add(world, ground());
                std::vector<Thing> things;
                for (int i = 0; i < 20; ++i) {
                    const double turn = 0.7 * i + seed;
                    BodyDescription body =
                        box(Vec3(edge), edge * Vec3(1.8 * (i % 4), 2.0 + 1.8 * (i / 4), 1.8 * (i % 3)), 0.2);
                    body.pose.rotation =
                        glm::normalize(Quat(std::cos(turn), std::sin(turn), 0.3 * std::sin(2.0 * turn), 0.2));
                    body.material = {.friction = friction, .restitution = 1.0};
                    body.linear_damping = body.angular_damping = 0.0;
                    body.can_sleep = false;
                    things.push_back(enter(world, body, Vec3(edge)));
                }
                const double whole = energy(world, things);
                EXPECT_LT(most_gained(world, things, 28'000), 0.03 * whole) << friction << ' ' << edge;
                EXPECT_LT(energy(world, things), 1.01 * whole) << friction << ' ' << edge;
            }
        }
    }
}

// Restitution reverses the speed of a point that hits the floor, and friction stops it. Together they would
// give energy to a box that comes in askew, up to a third of what it has. A ball keeps all of its bounce.
TEST(ExtremeBodies, AnObliqueBounceGainsNothing) {
    shared::RandomValues random(51);
    for (int i = 0; i < 300; ++i) {
        PhysicsWorld world = small_world();
        world.set_gravity(Vec3(0.0));
        add(world, ground());
        const bool is_ball = i % 3 == 0;
        const double edge = random.between(0.02, 0.2);
        const Vec3 size(edge, edge * random.between(0.1, 1.0), edge * random.between(0.1, 1.0));
        BodyDescription body =
            is_ball ? ball(0.5 * edge, {0.0, 0.3, 0.0}, 0.3) : box(size, {0.0, 0.3, 0.0}, 0.3);
        body.pose.rotation = random.rotation();
        body.linear_damping = body.angular_damping = 0.0;
        body.linear_velocity = {random.between(-3.0, 3.0), random.between(-3.0, -0.5),
                                random.between(-3.0, 3.0)};
        body.angular_velocity = random.in_box(10.0);
        body.material = {.friction = random.between(0.1, 2.0), .restitution = 1.0};
        body.can_sleep = false;
        const Thing thing = enter(world, body, is_ball ? Vec3(0.5 * edge * std::sqrt(2.4)) : size);
        const double whole = kinetic(world, thing);
        double most = whole;
        for (int k = 0; k < 600; ++k) {
            world.step(tick);
            most = std::max(most, kinetic(world, thing));
        }
        EXPECT_LT(most, 1.006 * whole) << i << ' ' << body.material.friction;
        if (is_ball) {
            EXPECT_NEAR(world.linear_velocity(thing.id).y, -body.linear_velocity.y, 1e-3) << i;
        }
    }
}

// Flat on the floor a cube bounces as high with friction as without, and loses no more than mu (1 + e) v to
// it.
TEST(ExtremeBodies, ACubeThatLandsFlatBouncesAsHighWithFriction) {
    for (const double restitution : {0.5, 0.8}) {
        PhysicsWorld world = small_world();
        world.set_gravity(Vec3(0.0));
        add(world, ground());
        BodyDescription body = box(Vec3(0.1), {0.0, 0.1, 0.0}, 0.3);
        body.linear_damping = body.angular_damping = 0.0;
        body.linear_velocity = {2.0, -1.0, 0.0};
        body.material = {.friction = 0.2, .restitution = restitution};
        const Thing thing = enter(world, body, Vec3(0.1));
        run(world, 100);
        const Vec3 after = world.linear_velocity(thing.id);
        EXPECT_NEAR(after.y, restitution, 0.02) << restitution;
        EXPECT_NEAR(after.x, 2.0 - 0.2 * (1.0 + restitution), 0.05) << restitution;
    }
}

TEST(ExtremeBodies, RandomHeapsThatGiveBackAllGainNothing) {
    for (int seed = 0; seed < 40; ++seed) {
        shared::RandomValues random(static_cast<std::uint64_t>(seed));
        PhysicsWorld world = small_world();
        add(world, ground());
        std::vector<Thing> things;
        for (int i = 0; i < 2 + seed % 10; ++i) {
            const double edge = random.between(0.02, 0.1);
            const Vec3 size(edge, edge * random.between(0.2, 1.0), edge * random.between(0.2, 1.0));
            const bool is_ball = random.unit() < 0.5;
            const Vec3 place(random.between(-0.1, 0.1), 0.12 + 0.13 * i, random.between(-0.1, 0.1));
            const double mass = random.magnitude(0.01, 1.0);
            BodyDescription body = is_ball ? ball(0.5 * edge, place, mass) : box(size, place, mass);
            body.pose.rotation = random.rotation();
            body.linear_damping = body.angular_damping = 0.0;
            body.linear_velocity = random.in_box(1.0);
            body.material = {.friction = 0.5, .restitution = 0.5};  // together 1
            body.can_sleep = false;
            things.push_back(enter(world, body, is_ball ? Vec3(0.5 * edge * std::sqrt(2.4)) : size));
        }
        const double whole = energy(world, things);
        EXPECT_LT(most_gained(world, things, 3000), 0.01 * whole) << seed;
    }
}

TEST(ExtremeBodies, SheetsAndNeedlesComeToRestOnTheFloor) {
    for (const Vec3& size : {Vec3(0.2, 0.0005, 0.2), Vec3(0.2, 0.001, 0.001), Vec3(0.001, 0.2, 0.001)}) {
        PhysicsWorld world = small_world();
        add(world, ground());
        std::vector<Thing> things;
        for (int i = 0; i < 5; ++i)
            things.push_back(enter_box(world, size, {0.002 * i, 0.15 + 0.05 * i, 0.001 * i}, 0.02));
        const double whole = energy(world, things);
        EXPECT_LT(most_gained(world, things, 4000), 0.01 * whole) << size.x << ' ' << size.y;
        for (const Thing& thing : things) {
            EXPECT_GT(world.pose(thing.id).position.y, 0.0) << size.x << ' ' << size.y;
            EXPECT_LT(glm::length(world.linear_velocity(thing.id)), 0.5) << size.x << ' ' << size.y;
        }
    }
}

TEST(ExtremeBodies, AHeapOfTwoHundredLosesEnergyAndStaysAboveTheFloor) {
    PhysicsWorld world = small_world(256);
    BodyDescription floor = box({10.0, 0.02, 10.0}, {0.0, -0.01, 0.0}, 1.0);
    floor.motion = Motion::Static;
    add(world, floor);
    std::vector<Thing> things;
    for (int i = 0; i < 200; ++i) {
        const Vec3 place{0.06 * (i % 5) + 0.01 * (i % 3), 0.05 + 0.06 * static_cast<double>(i / 25),
                         0.06 * static_cast<double>(i / 5 % 5)};
        things.push_back(i % 2 == 0 ? enter_box(world, Vec3(0.04), place, 0.1)
                                    : enter_ball(world, 0.025, place, 0.1));
    }
    const double whole = energy(world, things);
    EXPECT_LT(most_gained(world, things, 3000), 0.01 * whole);
    double moving = 0.0;
    for (const Thing& thing : things) {
        EXPECT_GT(world.pose(thing.id).position.y, 0.015);
        moving += kinetic(world, thing);
    }
    EXPECT_LT(moving, 0.02 * whole);
}

// They are pushed apart without a speed: what they weigh is lifted by it, and no more.
TEST(ExtremeBodies, BodiesThatBeginInsideEachOtherAreNotShotApart) {
    for (const double offset : {0.0, 1e-6, 0.01}) {
        PhysicsWorld world = small_world();
        world.set_gravity(Vec3(0.0));
        std::vector<Thing> things;
        for (int i = 0; i < 20; ++i)
            things.push_back(i % 2 == 0 ? enter_box(world, Vec3(0.05), Vec3(offset * i, 0.0, 0.0), 0.1)
                                        : enter_ball(world, 0.03, Vec3(offset * i, 0.0, 0.0), 0.1));
        double fastest = 0.0;
        for (int i = 0; i < 2000; ++i) {
            world.step(tick);
            for (const Thing& thing : things) {
                const double speed = glm::length(world.linear_velocity(thing.id));
                fastest = std::isfinite(speed) ? std::max(fastest, speed) : speed;
            }
        }
        EXPECT_LT(fastest, 0.05) << offset;
    }
}

// What no one meant: one inside the floor and one that a wall has cut in two.
TEST(ExtremeBodies, ABodyThatBeginsInsideTheFloorComesOutAndStays) {
    PhysicsWorld world = small_world();
    add(world, ground());
    BodyDescription wall = box({0.02, 1.0, 1.0}, {0.5, 0.5, 0.0}, 1.0);
    wall.motion = Motion::Static;
    add(world, wall);
    std::vector<Thing> things{enter_box(world, Vec3(0.1), {0.0, 0.01, 0.0}, 0.5),
                              enter_box(world, Vec3(0.1), {0.49, 0.05, 0.0}, 0.5)};
    double fastest = 0.0;
    for (int i = 0; i < 2000; ++i) {
        world.step(tick);
        for (const Thing& thing : things)
            fastest = std::max(fastest, glm::length(world.linear_velocity(thing.id)));
    }
    EXPECT_LT(fastest, 0.3);
    EXPECT_NEAR(world.pose(things[0].id).position.y, 0.05, 1e-3);
    EXPECT_NEAR(world.pose(things[1].id).position.y, 0.05, 1e-3);
}

}  // namespace
}  // namespace tactus::extreme_bodies_test
