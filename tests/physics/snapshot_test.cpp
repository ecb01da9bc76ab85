#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <random>
#include <vector>

#include "physics/physics_world.hpp"
#include "scene.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::snapshot_test {
namespace {

using namespace scene;

using Bytes = std::vector<std::byte>;

constexpr std::size_t room = 256 * 1024;  // (unit: bytes)

// The same forces for the same tick and seed, whoever asks.
Vec3 force_at(int tick_index, std::size_t body, unsigned seed) {
    std::minstd_rand random(seed * 7919u + static_cast<unsigned>(tick_index) * 31u +
                            static_cast<unsigned>(body) + 1u);
    const auto newtons = [&random] { return static_cast<double>(random() % 12001u) * 1e-3 - 6.0; };
    const double x = newtons();
    const double y = newtons();
    return {x, y, newtons()};
}

struct Play {
    explicit Play(int boxes, std::uint32_t remembered = 0) : world(settings(remembered)) {
        add(world, ground());
        for (int i = 0; i < boxes; ++i)
            ids.push_back(
                add(world, box(Vec3(0.1), {0.06 * (i % 3), 0.051 + 0.1005 * (i / 3), 0.03 * (i % 2)}, 0.4)));
    }

    static PhysicsSettings settings(std::uint32_t remembered) {
        PhysicsSettings result;
        result.max_bodies = 64;
        result.remembered_wakings = remembered;
        return result;
    }

    void advance(int from, int to, unsigned seed) {
        for (int t = from; t < to; ++t) {
            for (std::size_t i = 0; i < ids.size(); ++i)
                world.apply_force(ids[i], force_at(t, i, seed),
                                  world.center_of_mass(ids[i]) + Vec3(0.0, 0.03, 0.01));
            world.step(tick);
        }
    }

    Bytes saved(bool everything = false) const {
        Bytes bytes(room);
        bytes.resize(everything ? world.save_everything(bytes) : world.save(bytes));
        EXPECT_FALSE(bytes.empty());
        return bytes;
    }

    PhysicsWorld world;
    std::vector<BodyId> ids;
};

TEST(Snapshot, ThousandRandomRollbacksReplayToTheSameBits) {
    Play play(3);
    std::mt19937 random(1);
    std::uniform_int_distribution<int> length(1, 100);
    int now = 0;
    int mismatches = 0;
    for (unsigned round = 0; round < 1000; ++round) {
        const Bytes start = play.saved();
        const int end = now + length(random);
        play.advance(now, end, round);
        const Bytes first = play.saved();
        ASSERT_TRUE(play.world.restore(start));
        play.advance(now, end, round);
        mismatches += first == play.saved() ? 0 : 1;
        now = end;
    }
    EXPECT_EQ(mismatches, 0);
}

TEST(Snapshot, OtherInputsGiveAnotherPresentAndTheFirstOnesTheFirstAgain) {
    Play play(3);
    play.advance(0, 200, 1);
    const Bytes past = play.saved();
    play.advance(200, 300, 1);
    const Bytes present = play.saved();
    ASSERT_TRUE(play.world.restore(past));
    play.advance(200, 300, 2);
    EXPECT_NE(play.saved(), present);
    ASSERT_TRUE(play.world.restore(past));
    play.advance(200, 300, 1);
    EXPECT_EQ(play.saved(), present);
}

TEST(Snapshot, TwinWorldTakesEverythingOver) {
    Play first(4);
    Play second(4);
    first.advance(0, 500, 3);
    ASSERT_TRUE(second.world.restore(first.saved(true)));
    first.advance(500, 700, 4);
    second.advance(500, 700, 4);
    for (std::size_t i = 0; i < first.ids.size(); ++i) {
        EXPECT_EQ(first.world.pose(first.ids[i]).position, second.world.pose(second.ids[i]).position);
        EXPECT_EQ(first.world.pose(first.ids[i]).rotation, second.world.pose(second.ids[i]).rotation);
    }
}

TEST(Snapshot, WhatSleptThenSleepsAgainWhereItWas) {
    Play play(2, 16);
    run(play.world, 2000);
    ASSERT_FALSE(play.world.anything_awake());
    const Pose resting = play.world.pose(play.ids[0]);
    const Bytes past = play.saved();
    play.advance(0, 100, 5);
    ASSERT_TRUE(play.world.anything_awake());
    EXPECT_NE(play.world.pose(play.ids[0]).position, resting.position);
    ASSERT_TRUE(play.world.restore(past));
    EXPECT_FALSE(play.world.anything_awake());
    EXPECT_EQ(play.world.pose(play.ids[0]).position, resting.position);
    EXPECT_EQ(play.world.linear_velocity(play.ids[0]), Vec3(0.0));
}

TEST(Snapshot, SleepingBodiesAreNotInTheSnapshot) {
    Play few(1);
    Play many(9);
    for (std::size_t i = 1; i < many.ids.size(); ++i)
        many.world.sleep(many.ids[i]);
    for (Play* play : {&few, &many}) {
        play->world.set_pose(play->ids[0], {{5.0, 1.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)});
        for (std::size_t i = 1; i < play->ids.size(); ++i)
            play->world.sleep(play->ids[i]);
        run(play->world, 3);
        EXPECT_EQ(play->world.awake_count(), 1u);
    }
    EXPECT_EQ(few.saved().size(), many.saved().size());
}

TEST(Snapshot, RefusesWhenMoreBodiesWokeThanAreRemembered) {
    Play play(2, 1);
    run(play.world, 2000);
    const Bytes past = play.saved();
    play.advance(0, 1, 1);
    EXPECT_EQ(play.world.awake_count(), 2u);
    const Bytes present = play.saved();
    EXPECT_FALSE(play.world.restore(past));
    EXPECT_EQ(play.saved(), present);
}

TEST(Snapshot, MovedStaticBodyGoesBackToo) {
    Play play(1, 8);
    BodyDescription wall = box(Vec3(0.1), {2.0, 0.0, 0.0}, 1.0);
    wall.motion = Motion::Static;
    const BodyId id = add(play.world, wall);
    const Bytes past = play.saved();
    play.world.set_pose(id, {{3.0, 0.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)});
    ASSERT_TRUE(play.world.restore(past));
    EXPECT_EQ(play.world.pose(id).position.x, 2.0);
}

TEST(Snapshot, RefusesAfterBodiesChanged) {
    Play play(2);
    const Bytes past = play.saved();
    const PreparedBody gone = play.world.remove(play.ids[0]);
    EXPECT_FALSE(play.world.restore(past));
    EXPECT_FALSE(play.world.restore({}));
}

TEST(Snapshot, TooLittleMemoryWritesNothingAndSaysSo) {
    Play play(2);
    Bytes little(100);
    EXPECT_EQ(play.world.save(little), 0u);
}

TEST(Snapshot, AllocatesNothing) {
    Play play(6, 64);
    Bytes memory(room);
    Bytes full(room);
    play.advance(0, 100, 1);
    testing::AuditScope audit;
    for (int i = 0; i < 50; ++i) {
        const std::size_t bytes = play.world.save(memory);
        play.world.step(tick);
        play.world.restore(std::span(memory).first(bytes));
        play.world.save_everything(full);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations(), 0u) << audit.describe();
    EXPECT_EQ(audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(play.world.memory_overflows(), 0u);
}

}  // namespace
}  // namespace tactus::snapshot_test
