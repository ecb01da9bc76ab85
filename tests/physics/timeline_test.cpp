#include "physics/timeline.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "scene.hpp"
#include "support/realtime_audit.hpp"

namespace tactus {
namespace {

using namespace scene;

TimelineSettings small(std::uint32_t ticks = 256) {
    TimelineSettings settings;
    settings.physics.max_bodies = 32;
    settings.ticks = ticks;
    return settings;
}

Vec3 force_at(std::uint64_t tick_index, std::size_t body) {
    std::minstd_rand random(static_cast<unsigned>(tick_index * 31u + body + 1u));
    const auto newtons = [&random] { return static_cast<double>(random() % 12001u) * 1e-3 - 6.0; };
    const double x = newtons();
    return {x, newtons(), 0.0};
}

struct Play {
    explicit Play(int boxes, std::uint32_t ticks = 256) : timeline(small(ticks)) {
        join(ground());
        for (int i = 0; i < boxes; ++i)
            ids.push_back(join(box(Vec3(0.1), {0.104 * (i % 5), 0.05 + 0.1 * (i / 5), 0.0}, 0.5)));
    }

    BodyId join(const BodyDescription& description) {
        PreparedBody body = prepare(description);
        PreparedBody same = prepare(description);
        const BodyId id = timeline.add(body, same);
        EXPECT_TRUE(id.valid());
        return id;
    }

    void live(int ticks) {
        for (int i = 0; i < ticks; ++i) {
            for (std::size_t body = 0; body < ids.size(); ++body)
                timeline.apply_force(ids[body], force_at(timeline.tick(), body),
                                     timeline.world().center_of_mass(ids[body]) + Vec3(0.0, 0.03, 0.02));
            timeline.step(tick);
        }
    }

    std::vector<Pose> poses() const {
        std::vector<Pose> result;
        for (const BodyId id : ids)
            result.push_back(timeline.world().pose(id));
        return result;
    }

    Timeline timeline;
    std::vector<BodyId> ids;
};

void expect_same(const std::vector<Pose>& a, const std::vector<Pose>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].position, b[i].position);
        EXPECT_EQ(a[i].rotation, b[i].rotation);
    }
}

TEST(Timeline, ReplayWithoutNewTruthChangesNotOneBit) {
    Play play(4);
    Play plain(4);
    std::mt19937 random(3);
    for (int round = 0; round < 50; ++round) {
        const int ticks = 1 + static_cast<int>(random() % 60);
        play.live(ticks);
        plain.live(ticks);
        const std::uint64_t oldest = play.timeline.oldest_tick();
        const std::uint64_t at = oldest + random() % (play.timeline.tick() - oldest + 1);
        ASSERT_TRUE(play.timeline.correct(at, {}));
        EXPECT_TRUE(play.timeline.replay(1000));
        expect_same(play.poses(), plain.poses());
    }
}

TEST(Timeline, ReplaySpreadOverTicksCatchesUpWithTheMovingPresent) {
    Play play(4);
    Play plain(4);
    play.live(150);
    plain.live(150);
    ASSERT_TRUE(play.timeline.correct(50, {}));
    int calls = 0;
    bool done = false;
    while (!done) {
        done = play.timeline.replay(8);
        if (!done) {
            play.live(1);
            plain.live(1);
        }
        ASSERT_LT(++calls, 100);
    }
    EXPECT_GT(calls, 12);
    EXPECT_LT(calls, 18);
    expect_same(play.poses(), plain.poses());
    play.live(50);
    plain.live(50);
    expect_same(play.poses(), plain.poses());
}

// The hand's forces where the body then is, as they were in the world that was kicked.
class SameForces final : public PastInputs {
public:
    explicit SameForces(BodyId id) : id_(id) {}
    void act(std::uint64_t at, PhysicsWorld& world) override {
        world.apply_force(id_, force_at(at, 0), world.center_of_mass(id_) + Vec3(0.0, 0.03, 0.02));
    }

private:
    BodyId id_;
};

// One world was kicked and the other learns of it 60 ticks later.
TEST(Timeline, TruthFromThePastLeadsToThePresentOfTheOther) {
    Play real(1);
    Play model(1);
    real.live(100);
    model.live(100);
    real.timeline.set_velocity(real.ids[0], {0.5, 0.0, 0.1}, {0.0, 2.0, 0.0});
    const PhysicsWorld& world = real.timeline.world();
    const BodyTruth truth{real.ids[0], world.pose(real.ids[0]), world.linear_velocity(real.ids[0]),
                          world.angular_velocity(real.ids[0])};
    real.live(60);
    model.live(60);
    EXPECT_GT(glm::length(real.poses()[0].position - model.poses()[0].position), 0.005);
    SameForces forces(model.ids[0]);
    ASSERT_TRUE(model.timeline.correct(100, std::span(&truth, 1), &forces));
    EXPECT_TRUE(model.timeline.replay(1000));
    EXPECT_LT(glm::length(real.poses()[0].position - model.poses()[0].position), 1e-6);
    real.live(100);
    model.live(100);
    EXPECT_LT(glm::length(real.poses()[0].position - model.poses()[0].position), 1e-5);
}

TEST(Timeline, LaterCorrectionStartsFromTheCorrectedPast) {
    Play once(1);
    Play twice(1);
    once.live(120);
    twice.live(120);
    const BodyTruth truth{once.ids[0], {{0.3, 0.05, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}};
    for (Play* play : {&once, &twice}) {
        ASSERT_TRUE(play->timeline.correct(60, std::span(&truth, 1)));
        ASSERT_TRUE(play->timeline.replay(1000));
    }
    ASSERT_TRUE(twice.timeline.correct(90, {}));
    ASSERT_TRUE(twice.timeline.replay(1000));
    expect_same(once.poses(), twice.poses());
}

class Upward final : public PastInputs {
public:
    explicit Upward(BodyId id) : id_(id) {}
    void act(std::uint64_t, PhysicsWorld& world) override {
        world.apply_force(id_, {0.0, 20.0, 0.0}, world.center_of_mass(id_));
        ++calls;
    }
    int calls = 0;

private:
    BodyId id_;
};

TEST(Timeline, InputsCanBeComputedAnew) {
    Play play(1);
    play.live(100);
    Upward inputs(play.ids[0]);
    ASSERT_TRUE(play.timeline.correct(70, {}, &inputs));
    ASSERT_TRUE(play.timeline.replay(1000));
    EXPECT_EQ(inputs.calls, 30);
    EXPECT_GT(play.poses()[0].position.y, 0.053);
}

TEST(Timeline, ForgetsWhatIsTooOld) {
    Play play(1, 64);
    play.live(1000);
    EXPECT_GE(play.timeline.oldest_tick(), 1000u - 64u);
    EXPECT_LE(play.timeline.oldest_tick(), 1000u - 48u);
    EXPECT_FALSE(play.timeline.correct(900, {}));
    EXPECT_FALSE(play.timeline.correct(1001, {}));
    EXPECT_TRUE(play.timeline.correct(960, {}));
}

TEST(Timeline, PastEndsWhereABodyCame) {
    Play play(1);
    play.live(50);
    play.join(box(Vec3(0.1), {2.0, 0.05, 0.0}, 1.0));
    play.live(20);
    EXPECT_EQ(play.timeline.oldest_tick(), 50u);
    EXPECT_FALSE(play.timeline.correct(40, {}));
    ASSERT_TRUE(play.timeline.correct(60, {}));
    EXPECT_TRUE(play.timeline.replay(100));
}

// The twin's bodies are wherever its last replay left them; a joint is made where they are in the present.
TEST(Timeline, AJointMadeWhileBodiesMoveHoldsInTheReplayAsInThePresent) {
    for (const JointKind kind : {JointKind::Pin, JointKind::Hinge, JointKind::Slider, JointKind::SixAxes}) {
        Play play(4);
        Play plain(4);
        for (Play* each : {&play, &plain}) {
            each->live(200);
            JointDescription joint;
            joint.kind = kind;
            joint.frame = each->timeline.world().pose(each->ids[1]);
            joint.angular[2] = {-0.2, 0.3};
            joint.linear[0] = {-0.01, 0.02};
            ASSERT_TRUE(each->timeline.add_joint(joint, each->ids[1], each->ids[2]).valid());
            ASSERT_TRUE(each->timeline.add_joint(joint, each->ids[3], BodyId{}).valid());
            each->live(60);
        }
        ASSERT_TRUE(play.timeline.correct(play.timeline.oldest_tick(), {}));
        ASSERT_TRUE(play.timeline.replay(1000));
        expect_same(play.poses(), plain.poses());
        play.live(30);
        plain.live(30);
        expect_same(play.poses(), plain.poses());
    }
}

TEST(Timeline, AllocatesNothing) {
    Play play(3);
    play.live(100);
    const BodyTruth truth{play.ids[0], {{0.3, 0.05, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}};
    testing::AuditScope audit;
    for (int i = 0; i < 20; ++i) {
        play.timeline.apply_force(play.ids[0], {1.0, 0.0, 0.0}, Vec3(0.0));
        play.timeline.step(tick);
        play.timeline.correct(play.timeline.tick() - 40, std::span(&truth, 1));
        play.timeline.replay(100);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations(), 0u) << audit.describe();
    EXPECT_EQ(audit.frees(), 0u) << audit.describe();
}

}  // namespace
}  // namespace tactus
