// Scenes without an engine: who is there, who is looked at, what a script changes, and what is shown.
#include "world/body_mirrors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <limits>
#include <thread>
#include <utility>

#include "shared/meshes.hpp"
#include "shared/played_scene.hpp"

namespace tactus::body_mirrors_test {
namespace {

using shared::box_prop;
using shared::JointProp;
using shared::PlayedBody;
using shared::PlayedJoint;
using shared::Prop;

struct Scene {
    explicit Scene(bool in_turn = false) : mirrors(64, in_turn), session(settings()) {}
    static SessionSettings settings() {
        SessionSettings settings;
        settings.max_bodies = 64;
        settings.physics.gravity = Vec3(0.0);
        return settings;
    }

    Prop& add(double x = 0.0) {
        props.push_back(box_prop(props.size() + 1, x));
        has_changed = true;
        return props.back();
    }
    JointProp& join(std::uint64_t first, std::uint64_t second) {
        JointProp& joint = joints.emplace_back();
        joint.id = 100 + joints.size();
        joint.first = {first != 0, first};
        joint.second = {second != 0, second};
        has_changed = true;
        return joint;
    }
    void match() {
        std::vector<std::uint64_t> bodies, joined;
        for (const Prop& prop : props) {
            if (prop.is_there) {
                bodies.push_back(prop.id);
            }
        }
        for (const JointProp& joint : joints) {
            joined.push_back(joint.id);
        }
        mirrors.match(
            bodies, [this](std::uint64_t id) { return std::make_unique<PlayedBody>(props[id - 1]); }, joined,
            [this](std::uint64_t id) { return std::make_unique<PlayedJoint>(joints[id - 101]); }, session);
    }
    // A frame of one tick.
    void frame() {
        session.collect();
        if (std::exchange(has_changed, false)) {
            match();
        }
        MirrorContext context{session, workers, {}, 0.01, ticks + 1};
        context.together = together;
        context.mesh_changes = mesh_changes;
        context.engine_moves = engine_moves;
        mirrors.synchronise(context);
        session.tick(static_cast<Nanoseconds>(ticks++) * 1'000'000);
        if (session.refresh() && !engine_moves) {  // the engine shows them itself
            for (std::size_t i = 0; i < session.snapshot().body_count; ++i) {
                mirrors.show(session.snapshot().bodies[i], session.snapshot().tick, session);
            }
        }
    }
    // With a step of the engine's own physics, for which these bodies are close to a hand.
    void engine_frame(const std::vector<std::uint64_t>& close) {
        mirrors.exchange({session, {&hand, 1}, close, 0.01, 0.001, keeps_time});
        frame();
    }
    void frames(int count) {
        for (int i = 0; i < count; ++i) {
            frame();
        }
    }

    Workers workers;
    std::deque<Prop> props;
    std::deque<JointProp> joints;
    BodyMirrors mirrors;
    Session session;
    std::uint64_t ticks = 0, mesh_changes = 0;
    bool has_changed = true, together = false, engine_moves = false, keeps_time = true;
    Vec3 hand{100.0};
};

TEST(BodiesThatAnEngineMoves, AreNeitherReadNorThereFarFromHands) {
    for (const bool in_turn : {false, true}) {
        Scene scene(in_turn);
        scene.engine_moves = true;
        Prop& prop = scene.add();
        scene.frame();
        const BodyMirror& mirror = *scene.mirrors.bodies()[0];
        EXPECT_TRUE(mirror.is_far());
        EXPECT_FALSE(prop.tells_of_moves);
        EXPECT_EQ(mirror.twin().values().layers.layer, 0u);
        EXPECT_EQ(mirror.layers().layer, 1u);

        prop.frame.origin = {5.0, 0.0, 0.0};
        for (int i = 0; i < 200; ++i) {
            scene.engine_frame({});
        }
        EXPECT_EQ(mirror.twin().pose().position.x, 0.0) << "it was read";
        EXPECT_EQ(scene.mirrors.touchable(1).at(0).pose.position.x, 5.0) << "queries know where it is";

        scene.engine_frame({prop.id});
        EXPECT_FALSE(mirror.is_far());
        EXPECT_TRUE(prop.tells_of_moves);
        EXPECT_EQ(mirror.twin().values().layers.layer, 1u);
        EXPECT_EQ(mirror.twin().pose().position.x, 5.0);
        for (int i = 0; i < 40; ++i) {
            scene.engine_frame({});
        }
        EXPECT_TRUE(mirror.is_far());
        EXPECT_EQ(mirror.twin().values().layers.layer, 0u);
    }
}

TEST(BodiesThatAnEngineMoves, ArePushedOnlyWhileItKeepsTime) {
    Scene scene;
    scene.engine_moves = true;
    scene.hand = {0.15, 0.0, 0.0};
    Prop& prop = scene.add();
    for (const bool keeps_time : {true, false, true}) {
        scene.keeps_time = keeps_time;
        for (int i = 0; i < 5; ++i) {
            scene.engine_frame({prop.id});
        }
        const BodyMirror& mirror = *scene.mirrors.bodies()[0];
        EXPECT_EQ(mirror.is_led(), keeps_time);
        EXPECT_EQ(mirror.twin().values().motion, keeps_time ? Motion::Dynamic : Motion::Kinematic);
    }
}

TEST(BodiesThatAnEngineMoves, StayWhereTheyAreStill) {
    Scene scene;
    scene.engine_moves = true;
    Prop& prop = scene.add();
    prop.values.motion = Motion::Static;
    scene.frame();
    scene.engine_frame({});
    EXPECT_FALSE(scene.mirrors.bodies()[0]->is_far());
    EXPECT_EQ(scene.mirrors.bodies()[0]->twin().values().layers.layer, 1u);
    EXPECT_TRUE(prop.tells_of_moves);
}

TEST(BodyMirrors, ABodyThatIsThrownIsShownWhereItGoes) {
    Scene scene;
    Prop& body = scene.add();
    body.speed.linear = {1, 0, 0};
    scene.frames(200);
    EXPECT_NEAR(body.frame.origin.x, 0.2, 0.01);
    EXPECT_TRUE(body.is_held) << "the engine's own physics would move it as well";
    EXPECT_EQ(body.said, std::vector<std::string>{});
}

TEST(BodyMirrors, AScriptMovesAndThrowsABodyThatMoves) {
    for (const bool in_turn : {false, true}) {
        Scene scene(in_turn);
        Prop& body = scene.add();
        body.speed.linear = {1, 0, 0};
        scene.frames(20);
        body.frame.origin = {0, 5, 0};
        scene.frames(4);
        EXPECT_NEAR(body.frame.origin.y, 5.0, 1e-6) << in_turn;
        EXPECT_LT(body.frame.origin.x, 0.01) << in_turn;
        body.speed.linear = {0, 0, -1};
        scene.frames(100);
        EXPECT_LT(body.frame.origin.z, -0.08) << in_turn;
    }
}

TEST(BodyMirrors, ASpeedThatIsNoNumberIsWrittenOver) {
    Scene scene;
    Prop& body = scene.add();
    body.speed.linear = {1, 0, 0};
    scene.frames(20);
    body.speed.linear.y = std::numeric_limits<double>::quiet_NaN();
    scene.frames(20);
    EXPECT_NEAR(body.speed.linear.x, 1.0, 0.01);
    EXPECT_EQ(body.speed.linear.y, 0.0);
}

TEST(BodyMirrors, ASpeedIsSetOnlyWhereItIsAnotherOne) {
    Scene scene;
    Prop& body = scene.add();
    body.values.linear_damping = body.values.angular_damping = 0.0;
    body.makings.can_sleep = false;
    body.speed.linear = {0.5, 0, 0};
    scene.frames(100);
    EXPECT_GT(body.times_put, 90);
    EXPECT_LE(body.speeds_set, 1);
}

TEST(BodyMirrors, APlaceThatIsNoneIsSaidAndTheTwinStays) {
    Scene scene;
    Prop& body = scene.add();
    scene.frames(3);
    body.frame.origin.y = std::numeric_limits<double>::infinity();
    scene.frames(3);
    ASSERT_EQ(scene.mirrors.problems().size(), 1u);
    EXPECT_NE(scene.mirrors.problems().front().find("body 1: its transform is not made of finite"),
              std::string::npos)
        << scene.mirrors.problems().front();
    EXPECT_NE(scene.mirrors.bodies().front()->handle(), no_handle);
    body.frame.origin.y = 0.0;
    scene.frames(3);
    EXPECT_TRUE(scene.mirrors.problems().empty());
}

TEST(BodyMirrors, OneWithoutAPlaceIsMadeWhenItHasOne) {
    Scene scene;
    Prop& body = scene.add();
    const BodyForm whole = std::exchange(body.form, {});
    body.frame.axes = Mat3(0.0);
    scene.frames(3);
    EXPECT_EQ(scene.mirrors.bodies().front()->handle(), no_handle);
    body.form = whole;
    body.frame.axes = Mat3(1.0);
    scene.frames(3);
    EXPECT_NE(scene.mirrors.bodies().front()->handle(), no_handle);
}

TEST(BodyMirrors, AScaledBodyThatTurnsKeepsItsTwin) {
    Scene scene;
    Prop& body = scene.add();
    body.key.scaling = Mat3(2.0);
    scene.frames(3);
    const int forms_read = body.forms_read;
    const SessionHandle handle = scene.mirrors.bodies().front()->handle();
    body.key.scaling = Mat3(2.0000003);
    scene.frames(3);
    EXPECT_EQ(body.forms_read, forms_read);
    EXPECT_EQ(scene.mirrors.bodies().front()->handle(), handle);
    body.key.scaling = Mat3(2.1);
    scene.frames(1);
    EXPECT_GT(body.forms_read, forms_read);
}

TEST(BodyMirrors, AMeshIsLookedAtWhenOneHasChanged) {
    Scene scene(true);
    Prop& body = scene.add();
    body.form.touched = {
        MeshDraft{std::make_shared<TriangleSource>(
                      [] { return TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}; }, 1),
                  Mat3(1.0), Pose{}, 0.0, false, ""}};
    scene.frames(2);
    const int forms_read = body.forms_read;
    scene.frames(2);
    EXPECT_EQ(body.forms_read, forms_read);
    ++scene.mesh_changes;
    scene.frames(1);
    EXPECT_EQ(body.forms_read, forms_read + 1);
}

TEST(BodyMirrors, WhatMovesIsAskedAndWhatRestsIsTold) {
    Scene scene(true);
    Prop& body = scene.add();
    body.speed.linear = {1, 0, 0};
    scene.frames(5);
    EXPECT_FALSE(body.tells_of_moves);
    body.values.motion = Motion::Static;
    scene.mirrors.news()->changed.push_back(body.id);
    scene.frames(5);
    EXPECT_TRUE(body.tells_of_moves);
}

TEST(BodyMirrors, AMoveThatIsToldOfIsFollowedAtOnce) {
    Scene scene(true);
    for (int i = 0; i < 60; ++i) {
        scene.add(i).is_rigid = false;
        scene.props.back().values.motion = Motion::Static;
    }
    scene.frames(2);
    scene.props[40].frame.origin = {0, 3, 0};
    scene.mirrors.news()->moved.push_back(41);
    scene.frame();
    EXPECT_EQ(scene.mirrors.of(41)->twin().pose().position, Vec3(0, 3, 0));
}

TEST(BodyMirrors, EachIsLookedAtInTurnAndTheTouchedAlways) {
    Scene scene(true);
    for (int i = 0; i < 60; ++i) {
        scene.add(i);
    }
    scene.frames(2);
    scene.mirrors.touched({7});
    for (Prop& prop : scene.props) {
        prop.values.gravity_scale = 0.5;
    }
    scene.frame();
    const auto gravity = [&](std::uint64_t id) {
        return scene.mirrors.of(id)->twin().values().gravity_scale;
    };
    EXPECT_EQ(gravity(7), 0.5);
    const auto seen = [&] {
        return std::ranges::count_if(scene.props, [&](const Prop& prop) { return gravity(prop.id) == 0.5; });
    };
    EXPECT_LT(seen(), 10);
    scene.frames(60);
    EXPECT_EQ(seen(), 60);
}

TEST(BodyMirrors, OneThatIsFreedAsItIsMovedIsAskedNothingMore) {
    Scene scene;
    Prop& body = scene.add();
    body.speed.linear = {1, 0, 0};
    body.when_moved = [&body] { body.is_there = false; };
    scene.frames(3);
    EXPECT_EQ(scene.mirrors.bodies().front()->body(), nullptr);
    scene.has_changed = true;
    scene.frame();
    EXPECT_TRUE(scene.mirrors.bodies().empty());
    EXPECT_EQ(scene.mirrors.of(body.id), nullptr);
}

TEST(BodyMirrors, OneOutsideOfTheSceneIsNotMoved) {
    Scene scene;
    Prop& body = scene.add();
    body.speed.linear = {1, 0, 0};
    scene.frames(3);
    body.is_in_scene = false;
    const int times_put = body.times_put;
    scene.frames(3);
    EXPECT_EQ(body.times_put, times_put);
}

TEST(BodyMirrors, WhatIsReleasedIsGivenBack) {
    Scene scene;
    Prop& body = scene.add();
    scene.frames(3);
    EXPECT_TRUE(body.is_listened_to);
    scene.mirrors.release(scene.session);
    EXPECT_FALSE(body.is_held);
    EXPECT_FALSE(body.is_listened_to);
}

TEST(BodyMirrors, WhatTheSceneIsMadeOf) {
    Scene scene;
    scene.add(0.0).values.layers.layer = 0b01;
    scene.add(3.0).values.layers.layer = 0b10;
    scene.frames(2);
    EXPECT_EQ(scene.mirrors.facts().bodies, 2u);
    EXPECT_EQ(scene.mirrors.facts().layers, 0b11u);
    const std::vector<QueriedBody> touchable = scene.mirrors.touchable(0b10);
    ASSERT_EQ(touchable.size(), 1u);
    EXPECT_EQ(scene.mirrors.bodies()[touchable.front().index]->id(), 2u);
}

TEST(JointMirror, JoinsOnceItsBodiesAreThere) {
    Scene scene;
    scene.join(1, 2);
    scene.joints.front().problem = "its node_b is no body";
    scene.add(0.0);
    scene.frames(2);
    EXPECT_EQ(scene.mirrors.joints().front()->twin().handle(), no_handle);
    EXPECT_EQ(scene.joints.front().said.front(), "its node_b is no body");
    EXPECT_EQ(scene.mirrors.problems().front(), "joint 101: its node_b is no body");
    scene.add(1.0);
    scene.joints.front().problem.clear();
    scene.frames(2);
    EXPECT_NE(scene.mirrors.joints().front()->twin().handle(), no_handle);
    EXPECT_TRUE(scene.mirrors.problems().empty());
}

TEST(JointMirror, ABodyAloneIsTheFirst) {
    Scene scene;
    scene.add(0.0);
    scene.join(0, 1);
    scene.frames(2);
    const JointTwin& twin = scene.mirrors.joints().front()->twin();
    EXPECT_NE(twin.handle(), no_handle);
    EXPECT_EQ(twin.first(), scene.mirrors.of(1)->handle());
    EXPECT_EQ(twin.second(), no_handle);
}

TEST(JointMirror, OneThatJoinsNothingDoesNot) {
    Scene scene;
    scene.add(0.0);
    scene.join(0, 0).problem = "it joins nothing";
    scene.frames(2);
    EXPECT_EQ(scene.mirrors.joints().front()->problem(), "it joins nothing");
}

TEST(JointMirror, AGameThatEmptiesAJointMakesNoMistake) {
    Scene scene;
    scene.add(0.0);
    scene.join(0, 1);
    scene.frames(2);
    JointProp& joint = scene.joints.front();
    joint.first = joint.second = {};
    joint.problem = "it joins nothing";
    scene.frames(2);
    EXPECT_EQ(scene.mirrors.joints().front()->twin().handle(), no_handle);
    EXPECT_TRUE(joint.said.empty());
    EXPECT_TRUE(scene.mirrors.problems().empty());
}

// A frame that turns by small rotations loses its scale bit by bit.
TEST(BodyMirrors, CitizenABodyWhoseScaleDriftsIsNotMadeAnew) {
    Scene scene;
    Prop& body = scene.add();
    body.key.scaling = Mat3(2.0);
    scene.frames(2);
    const int read = body.forms_read;
    for (int i = 0; i < 500; ++i) {
        body.key.scaling *= 1.0 + 1e-6;
        scene.frame();
    }
    EXPECT_EQ(body.forms_read, read);
    body.key.scaling *= 1.0 + 2e-5;
    scene.frame();
    EXPECT_EQ(body.forms_read, read + 1) << "a step that rounding does not explain";
    for (int i = 0; i < 1100; ++i) {
        body.key.scaling *= 1.0 + 1e-6;
        scene.frame();
    }
    EXPECT_EQ(body.forms_read, read + 2) << "a thousandth is no drift";
}

// What moves takes along in the scene what stands below it; physics does not.
TEST(BodyMirrors, CitizenWhatStandsBelowABodyMovesByItself) {
    for (const bool in_turn : {false, true}) {
        Scene scene(in_turn);
        Prop& parent = scene.add();
        Prop& child = scene.add(5.0);
        child.carrier = parent.id;
        parent.speed.linear = {1, 0, 0};
        Vec3 before = parent.frame.origin;
        parent.when_moved = [&] {
            child.frame.origin += parent.frame.origin - before;
            before = parent.frame.origin;
        };
        scene.frames(100);
        EXPECT_NEAR(parent.frame.origin.x, 0.1, 0.01) << in_turn;
        EXPECT_NEAR(child.frame.origin.x, 5.0, 1e-9) << in_turn;
        child.frame.origin.y = 1.0;
        scene.frames(3);
        EXPECT_NEAR(child.frame.origin.y, 1.0, 1e-6) << in_turn;
        EXPECT_NEAR(child.frame.origin.x, 5.0, 1e-6) << in_turn;
    }
}

// A floor of many triangles and what lies on it.
TEST(BodyMirrors, CitizenWhatComesAtOnceIsThereAtOnce) {
    Scene scene(true);
    scene.together = true;
    scene.frames(2);
    Prop& floor = scene.add();
    floor.form.shapes.clear();
    const auto source = std::make_shared<TriangleSource>(
        [] {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            return shared::icosphere(2, 1.0);
        },
        100'000);
    floor.form.meshes = {MeshDraft{source, Mat3(1.0), Pose{}, 0.0, false, ""}};
    scene.add(5.0);
    scene.frame();
    EXPECT_EQ(scene.mirrors.building(), 2u);
    EXPECT_EQ(scene.mirrors.bodies().back()->handle(), no_handle);
    scene.add(9.0);
    scene.frame();
    EXPECT_NE(scene.mirrors.bodies().back()->handle(), no_handle) << "what comes later does not wait";
    scene.workers.wait();
    scene.frame();
    EXPECT_EQ(scene.mirrors.building(), 0u);
    for (const auto& mirror : scene.mirrors.bodies()) {
        EXPECT_NE(mirror->handle(), no_handle);
    }
}

}  // namespace
}  // namespace tactus::body_mirrors_test
