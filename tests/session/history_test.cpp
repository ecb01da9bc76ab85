// Time travel in a session: what was true then is put in, what the hand did since is replayed.
#include <glm/geometric.hpp>
#include <vector>

#include "session_rig.hpp"
#include "support/realtime_audit.hpp"

namespace tactus {
namespace {

using namespace session_test;

SessionSettings with_history(std::uint32_t ticks = 256) {
    SessionSettings settings;
    settings.most_bodies = 32;
    settings.history.ticks = ticks;
    return settings;
}

// A finger that pushes a box to and fro over the ground; a second box lies beside its way.
struct Pushed {
    explicit Pushed(const SessionSettings& settings = with_history()) : rig(settings) {
        rig.add(ground());
        box = rig.add(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, 0.5));
        other = rig.add(body(BoxShape{Vec3(0.05)}, {0.3, 0.05, 0.5}, Motion::Dynamic, 0.5));
        rig.device.position = {-0.08, 0.04, 0.0};
        rig.tick();
    }

    void live(int count) {
        for (int i = 0; i < count; ++i) {
            const double phase = 0.004 * ++ticks;
            rig.device.position.x = -0.08 + 0.06 * std::sin(phase);
            rig.device.velocity.x = 0.24 * std::cos(phase);
            rig.tick();
        }
    }

    std::uint64_t now() { return rig.newest().tick; }

    BodyCorrection state(SessionHandle handle) {
        const BodyState& state = *rig.state_of(handle);
        return {handle, state.pose, state.linear_velocity, state.angular_velocity};
    }

    SessionRig rig;
    SessionHandle box = no_handle, other = no_handle;
    int ticks = 0;
};

TEST(SessionHistory, WithoutOneNothingCanBeCorrected) {
    Pushed play(SessionSettings{});
    play.live(100);
    EXPECT_FALSE(play.rig.session.correct(50, {}));
    EXPECT_EQ(play.rig.session.oldest_correctable_tick(), play.now() + 1);
}

TEST(SessionHistory, AReplayWithoutNewsChangesNotOneBit) {
    Pushed play;
    Pushed plain;
    play.live(300);
    plain.live(300);
    for (const int back : {1, 20, 90, 200}) {
        ASSERT_TRUE(play.rig.session.correct(play.now() - static_cast<std::uint64_t>(back), {}));
        EXPECT_TRUE(play.rig.session.correcting());
        for (int i = 0; i < 150; ++i) {
            play.live(1);
            plain.live(1);
            ASSERT_EQ(play.state(play.box).pose.position, plain.state(plain.box).pose.position);
            ASSERT_EQ(play.state(play.box).pose.rotation, plain.state(plain.box).pose.rotation);
            ASSERT_EQ(play.rig.device.force, plain.rig.device.force);
        }
        EXPECT_FALSE(play.rig.session.correcting());
    }
}

// Two sessions with the same hand; in one the other box is kicked. The second learns of it 80 ticks later.
TEST(SessionHistory, TruthOfThePastLeadsToTheOthersPresent) {
    Pushed real;
    Pushed model;
    real.live(200);
    model.live(200);
    real.rig.session.set_body_velocity(real.other, {0.6, 0.0, 0.2}, {0.0, 1.0, 0.0});
    real.live(1);
    model.live(1);
    real.live(1);
    model.live(1);
    const std::uint64_t then = real.now();
    const BodyCorrection truth = real.state(real.other);
    real.live(80);
    model.live(80);
    EXPECT_GT(glm::distance(real.state(real.other).pose.position, model.state(model.other).pose.position),
              0.01);
    ASSERT_TRUE(model.rig.session.correct(then, {&truth, 1}));
    for (int i = 0; i < 60; ++i) {
        real.live(1);
        model.live(1);
    }
    EXPECT_FALSE(model.rig.session.correcting());
    EXPECT_LT(glm::distance(real.state(real.other).pose.position, model.state(model.other).pose.position),
              1e-5);
    EXPECT_EQ(real.state(real.box).pose.position, model.state(model.box).pose.position);
}

// The finger feels a box that has been moved under it, and does not end inside of it.
TEST(SessionHistory, ACorrectedBodyTakesTheFingerAlong) {
    Pushed play;
    play.live(400);
    BodyCorrection truth = play.state(play.box);
    const std::uint64_t then = play.now();
    play.live(50);
    truth.pose.position.x -= 0.02;  // towards the finger
    ASSERT_TRUE(play.rig.session.correct(then, {&truth, 1}));
    bool seen = false;
    for (int i = 0; i < 60 && !seen; ++i) {
        const Vec3 before = play.state(play.box).pose.position;
        play.live(1);
        for (const CorrectedBody& corrected : play.rig.session.corrected()) {
            if (corrected.body == play.box) {
                seen = true;
                EXPECT_LT(glm::distance(corrected.before.position, before), 1e-4);
            }
        }
    }
    ASSERT_TRUE(seen);
    const double face = play.state(play.box).pose.position.x - 0.05;
    EXPECT_LT(play.rig.proxy_state().position.x, face - 0.01 + 1e-5);
    EXPECT_EQ(play.rig.proxy_state().status & proxy_absent, 0u);
}

TEST(SessionHistory, WhatTheOwnerDoesInTheTickOfTheJumpIsKept) {
    Pushed play;
    play.live(200);
    ASSERT_TRUE(play.rig.session.correct(play.now() - 1, {}));
    const Pose there{{0.8, 0.05, 0.8}, Quat(1.0, 0.0, 0.0, 0.0)};
    while (play.rig.session.correcting()) {
        play.rig.session.teleport_body(play.other, there);
        play.live(1);
    }
    play.live(20);
    EXPECT_LT(glm::distance(play.state(play.other).pose.position, there.position), 1e-3);
}

TEST(SessionHistory, EndsWhereABodyCame) {
    Pushed play;
    play.live(100);
    play.rig.add(body(SphereShape{0.05}, {0.0, 0.05, -0.5}, Motion::Dynamic));
    play.live(20);
    EXPECT_FALSE(play.rig.session.correct(50, {}));
    EXPECT_TRUE(play.rig.session.correct(play.now() - 10, {}));
}

TEST(SessionHistory, ACorrectionAllocatesNothing) {
    Pushed play;
    play.live(300);
    BodyCorrection truth = play.state(play.box);
    truth.pose.position.x += 0.01;
    testing::AuditScope audit;
    for (int i = 0; i < 5; ++i) {
        play.rig.session.correct(play.rig.newest().tick - 60, {&truth, 1});
        play.live(50);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations(), 0u) << audit.describe();
    EXPECT_EQ(audit.frees(), 0u) << audit.describe();
}

}  // namespace
}  // namespace tactus
