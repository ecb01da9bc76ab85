#include "physics/far_islands.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "scene.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::far_islands_test {
namespace {

using namespace scene;

PhysicsSettings limited(std::uint32_t full_rate) {
    PhysicsSettings settings;
    settings.max_bodies = 512;
    settings.full_rate_bodies = full_rate;
    return settings;
}

// Boxes of 0.1 m in rows of 16, 0.2 m apart, on the ground; the hand is over the first.
struct Field {
    Field(int count, std::uint32_t full_rate, double height = 0.05) : world(limited(full_rate)) {
        add(world, ground());
        for (int i = 0; i < count; ++i) {
            BodyDescription body =
                box(Vec3(0.1), {0.2 * (i % 16), height, 0.2 * static_cast<double>(i / 16)}, 1.0);
            body.material.friction = 0.5;
            ids.push_back(add(world, body));
        }
        world.set_hands(std::span(&hand, 1));
    }

    void throw_all(const Vec3& velocity) {
        for (const BodyId id : ids)
            world.set_velocity(id, velocity, Vec3(0.0));
    }

    Vec3 place(std::size_t i) const { return world.pose(ids[i]).position; }

    Vec3 hand{0.0, 0.15, 0.0};
    PhysicsWorld world;
    std::vector<BodyId> ids;
};

TEST(FarIslands, FewBodiesTakeEveryStepAsWithoutALimit) {
    Field limited_field(40, 64);
    Field free_field(40, 0);
    limited_field.throw_all({0.5, 0.0, 0.2});
    free_field.throw_all({0.5, 0.0, 0.2});
    for (int i = 0; i < 300; ++i) {
        limited_field.world.step(tick);
        free_field.world.step(tick);
        ASSERT_EQ(limited_field.world.slowed_count(), 0u);
    }
    for (std::size_t i = 0; i < 40; ++i)
        EXPECT_EQ(limited_field.place(i), free_field.place(i));
}

// Of `ticks` steps, those in which the first body has moved, and those in which the 200th has.
std::pair<int, int> steps_with_a_move(Field& field, int ticks) {
    std::pair<int, int> moved{0, 0};
    for (int i = 0; i < ticks; ++i) {
        const Vec3 first = field.place(0);
        const Vec3 last = field.place(199);
        field.world.step(tick);
        moved.first += field.place(0) != first ? 1 : 0;
        moved.second += field.place(199) != last ? 1 : 0;
    }
    return moved;
}

TEST(FarIslands, BeyondTheLimitTheFarthestAreSlowed) {
    Field field(200, 64);
    field.throw_all({0.0, 3.0, 0.0});  // in the air for 0.6 s: none of them sleeps
    run(field.world, 40);
    EXPECT_EQ(field.world.awake_count(), 200u);
    EXPECT_GE(field.world.slowed_count(), 136u);
    EXPECT_LE(field.world.slowed_count(), 160u);
    // The first, under the hand, moves in every step; the last in one of sixteen.
    const auto [first, last] = steps_with_a_move(field, 64);
    EXPECT_EQ(first, 64);
    EXPECT_EQ(last, 4);
}

TEST(FarIslands, NoStepMovesMoreThanTheFullRateAndATurn) {
    Field field(400, 64);
    field.throw_all({0.0, 3.0, 0.0});
    run(field.world, 40);
    std::size_t most = 0;
    for (int i = 0; i < 100; ++i) {
        field.world.step(tick);
        most = std::max(most, field.world.moved().size());
    }
    EXPECT_LE(most, 64u + 400u / 16u);
}

// A floor of 20 mm, and bodies that go 50 mm in a long step.
TEST(FarIslands, WhatIsSlowedDoesNotFallThrough) {
    for (const double size : {0.01, 0.04}) {
        PhysicsWorld world(limited(64));
        BodyDescription floor = box({20.0, 0.02, 20.0}, {0.0, -0.01, 0.0}, 1.0);
        floor.motion = Motion::Static;
        add(world, floor);
        std::vector<BodyId> ids;
        for (int i = 0; i < 300; ++i)
            ids.push_back(add(
                world, ball(size, {0.12 * (i % 20), 0.5 + size, 0.12 * static_cast<double>(i / 20)}, 0.05)));
        std::size_t slowed = 0;
        for (int i = 0; i < 1000; ++i) {
            world.step(tick);
            slowed = std::max(slowed, world.slowed_count());
        }
        EXPECT_GT(slowed, 200u);
        for (const BodyId id : ids)
            ASSERT_NEAR(world.pose(id).position.y, size, 1e-3) << size;
    }
}

// Their speed asks for more than one step of 16 ms, but not for each.
TEST(FarIslands, WhatMovesSlowlyTakesEveryFourthStep) {
    Field field(200, 64);
    field.throw_all({1.0, 0.0, 0.0});
    run(field.world, 60);
    EXPECT_GE(field.world.slowed_count(), 100u);
    const auto [first, last] = steps_with_a_move(field, 32);
    EXPECT_EQ(first, 32);
    EXPECT_EQ(last, 8);
}

// Without slip after 2/7 of its speed is gone, whichever steps it takes.
TEST(FarIslands, SlowedBallsRollAsTheyWouldAlone) {
    PhysicsWorld world(limited(64));
    add(world, ground());
    std::vector<BodyId> ids;
    for (int i = 0; i < 200; ++i) {
        BodyDescription body = ball(0.04, {0.3 * (i % 16), 0.04, 0.3 * static_cast<double>(i / 16)}, 0.5);
        body.material.friction = 0.5;
        body.linear_velocity = {0.7, 0.0, 0.0};
        ids.push_back(add(world, body));
    }
    run(world, 500);
    EXPECT_GE(world.slowed_count(), 100u);
    for (const BodyId id : ids) {
        EXPECT_NEAR(world.linear_velocity(id).x, 0.5, 0.005);
        EXPECT_NEAR(world.angular_velocity(id).z * -0.04, 0.5, 0.005);
    }
}

// What slides stops where it would alone, within 1 %, whichever steps it takes.
TEST(FarIslands, FastOnesEndWhereTheyWouldAlone) {
    Field crowd(200, 64);
    Field alone(1, 64);
    for (Field* field : {&crowd, &alone}) {
        field->throw_all({1.0, 0.0, 0.0});
        run(field->world, 600);
    }
    const double way = alone.place(0).x;
    for (std::size_t i = 0; i < 200; ++i)
        EXPECT_NEAR(crowd.place(i).x - 0.2 * static_cast<double>(i % 16), way, 0.01 * way) << i;
}

// Explicit Euler with steps of 16 ms instead of one is behind or ahead by g t 16 ms / 2.
TEST(FarIslands, WhatIsSlowedFallsAsFarInTheSameTime) {
    Field field(200, 64, 5.05);
    run(field.world, 480);
    const double exact = 5.05 - 0.5 * 9.81 * 0.480 * 0.480;
    for (const std::size_t i : {std::size_t{0}, std::size_t{100}, std::size_t{199}}) {
        const double late = 16e-3 * 9.81 * 0.48;
        EXPECT_NEAR(field.place(i).y, exact, 1.6 * late) << i;
        EXPECT_NEAR(field.world.linear_velocity(field.ids[i]).y, -9.81 * 0.48, 9.81 * 17e-3) << i;
        EXPECT_EQ(field.world.state(field.ids[i]).linear_velocity, field.world.linear_velocity(field.ids[i]));
        EXPECT_EQ(field.world.state(field.ids[i]).pose.position, field.place(i));
    }
}

// To half of what 0.3 m/s covers in a step of 16 ms.
TEST(FarIslands, WhatIsSlowedSlidesToTheSamePlaceAndSleeps) {
    Field slowed(200, 64);
    Field full(200, 0);
    for (Field* field : {&slowed, &full}) {
        field->throw_all({0.0, 0.0, 0.3});
        run(field->world, 2500);
    }
    EXPECT_EQ(slowed.world.awake_count(), 0u);
    EXPECT_EQ(slowed.world.slowed_count(), 0u);
    for (std::size_t i = 0; i < 200; ++i)
        EXPECT_LT(glm::distance(slowed.place(i), full.place(i)), 2.4e-3) << i;
}

// Towers of three: contacts between slowed bodies keep their forces from turn to turn.
TEST(FarIslands, SlowedTowersStand) {
    PhysicsWorld world(limited(16));
    add(world, ground());
    std::vector<BodyId> ids;
    for (int i = 0; i < 60; ++i) {
        BodyDescription body = box(Vec3(0.1), {1.0 + 0.3 * (i / 3), 0.05 + 0.1 * (i % 3), 0.0}, 1.0);
        body.can_sleep = false;
        ids.push_back(add(world, body));
    }
    const Vec3 hand{0.0, 0.1, 0.0};
    world.set_hands(std::span(&hand, 1));
    run(world, 200);
    EXPECT_GE(world.slowed_count(), 42u);
    std::vector<Pose> before;
    for (const BodyId id : ids)
        before.push_back(world.pose(id));
    run(world, 3000);
    for (std::size_t i = 0; i < ids.size(); ++i)
        EXPECT_LT(glm::distance(world.pose(ids[i]).position, before[i].position), 2e-4) << i;
}

TEST(FarIslands, AHandThatComesNearBringsTheFullRate) {
    Field field(200, 64);
    field.throw_all({0.0, 3.0, 0.0});
    run(field.world, 40);
    field.hand = field.place(199);
    field.world.set_hands(std::span(&field.hand, 1));
    run(field.world, 16);
    int moved = 0;
    for (int i = 0; i < 16; ++i) {
        const double before = field.place(199).y;
        field.world.step(tick);
        moved += field.place(199).y != before ? 1 : 0;
    }
    EXPECT_EQ(moved, 16);
}

TEST(FarIslands, AForceOnASlowedBodyActsInTheNextStep) {
    Field field(200, 64);
    field.throw_all({0.0, 3.0, 0.0});
    run(field.world, 40);
    const BodyId id = field.ids[199];
    const Vec3 before = field.world.linear_velocity(id);
    EXPECT_GT(before.y, 2.0);
    field.world.apply_force(id, {1000.0, 0.0, 0.0}, field.world.center_of_mass(id));
    field.world.step(tick);
    EXPECT_NEAR(field.world.linear_velocity(id).x, 1.0, 1e-3);
    EXPECT_NEAR(field.world.linear_velocity(id).y, before.y, 0.05);
}

// What runs into a slowed body finds it with the velocity it has.
TEST(FarIslands, ASlowedBodyThatIsHitMovesOn) {
    PhysicsWorld world(limited(16));
    world.set_gravity(Vec3(0.0));
    std::vector<BodyId> ids;
    for (int i = 0; i < 60; ++i)
        ids.push_back(add(world, ball(0.02, {1.0, 0.1 * i, 0.0}, 1.0)));
    const BodyId target = add(world, ball(0.05, {0.5, 0.0, 1.0}, 1.0));
    for (const BodyId id : ids)
        world.set_velocity(id, {0.0, 0.0, 0.05}, Vec3(0.0));
    world.set_velocity(target, {0.0, 0.2, 0.0}, Vec3(0.0));
    const Vec3 hand{-3.0, 0.0, 0.0};
    world.set_hands(std::span(&hand, 1));
    run(world, 40);
    EXPECT_GT(world.slowed_count(), 40u);
    const BodyId bullet = add(world, ball(0.05, world.pose(target).position - Vec3(0.3, 0.0, 0.0), 1.0));
    world.set_velocity(bullet, {3.0, 0.2, 0.0}, Vec3(0.0));
    run(world, 200);
    const Vec3 sum = world.linear_velocity(target) + world.linear_velocity(bullet);
    EXPECT_NEAR(sum.x, 3.0, 0.05);
    EXPECT_NEAR(sum.y, 0.4, 0.05);
    EXPECT_GT(world.linear_velocity(target).x, 1.0);
}

TEST(FarIslands, SlowedBodiesCanBeRemovedMovedAndPutToSleep) {
    Field field(200, 64);
    field.throw_all({0.0, 3.0, 0.0});
    run(field.world, 40);
    PreparedBody removed = field.world.remove(field.ids[199]);
    EXPECT_TRUE(removed.ready());
    field.world.sleep(field.ids[198]);
    EXPECT_FALSE(field.world.awake(field.ids[198]));
    field.world.set_pose(field.ids[197], {{9.0, 9.0, 9.0}, Quat(1.0, 0.0, 0.0, 0.0)});
    EXPECT_EQ(field.world.awake_count(), 198u);
    run(field.world, 40);
    EXPECT_LT(glm::distance(field.place(197), Vec3(9.0, 9.0, 9.0)), 0.2);
    EXPECT_EQ(field.world.awake_count(), 198u);
}

TEST(FarIslands, TwoRunsAreTheSameToTheLastBit) {
    Field first(300, 32);
    Field second(300, 32);
    for (Field* field : {&first, &second}) {
        field->throw_all({0.7, 1.0, 0.4});
        run(field->world, 700);
    }
    for (std::size_t i = 0; i < 300; ++i)
        EXPECT_EQ(first.place(i), second.place(i));
}

TEST(FarIslands, NothingIsAllocated) {
    Field field(200, 64);
    field.throw_all({0.3, 3.0, 0.1});
    testing::AuditScope audit;
    for (int i = 0; i < 1500; ++i) {
        field.hand.x = 0.002 * i;
        field.world.set_hands(std::span(&field.hand, 1));
        field.world.step(tick);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations(), 0u) << audit.describe();
    EXPECT_EQ(audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(field.world.memory_overflows(), 0u);
}

}  // namespace
}  // namespace tactus::far_islands_test
