// A world that runs without anything to show: its time, its pushes, who hears it, and what it tells far
// sides.
#include "world/running_world.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "shared/played_scene.hpp"
#include "world/hand_twins.hpp"
#include "world/scene_telling.hpp"

namespace tactus::running_world_test {
namespace {

constexpr std::uint8_t model_mediated = 4;

SessionSettings settings(Nanoseconds period = 1'000'000) {
    SessionSettings settings;
    settings.period = period;
    settings.max_bodies = 8;
    settings.physics.gravity = Vec3(0.0);
    return settings;
}

SessionHandle add_box(RunningWorld& world) {
    BodyAddition addition;
    addition.description.shapes = {PlacedShape{BoxShape{Vec3(0.1)}, Pose{}}};
    addition.description.motion = Motion::Dynamic;
    return world.session().add_body(addition).handle;
}

Vec3 speed_of_first_body(RunningWorld& world) {
    world.session().refresh();
    return world.session().snapshot().body_count > 0 ? world.session().snapshot().bodies[0].linear_velocity
                                                     : Vec3(0.0);
}

TEST(RunningWorld, TicksAsOftenAsThereIsTimeFor) {
    RunningWorld world(settings(), false, Pose{}, {});
    EXPECT_EQ(world.advance(0.0104), 10);
    EXPECT_EQ(world.advance(0.0003), 0);
    EXPECT_EQ(world.advance(0.0003), 1) << "what was left is owed";
    EXPECT_EQ(world.loop().ticks(), 11u);
    std::int64_t ticks = 0;
    for (int i = 0; i < 1000; ++i) {
        ticks += world.advance(0.0001);
    }
    EXPECT_EQ(ticks, 100) << "many small times are not lost to rounding";
}

TEST(RunningWorld, APushActsAtOnceAndAForceForTheNextFrame) {
    RunningWorld world(settings(), false, Pose{}, {});
    const SessionHandle box = add_box(world);
    const BodyPush newtons{.impulse = {2, 0, 0}, .central = true};
    world.push(box, newtons, false);
    world.push_for(0.5);
    world.advance(0.002);
    const double by_impulse = speed_of_first_body(world).x;
    EXPECT_GT(by_impulse, 0.0);
    world.push(box, newtons, true);
    world.push_for(0.5);
    world.push_for(0.5);
    world.advance(0.002);
    EXPECT_NEAR(speed_of_first_body(world).x, 1.5 * by_impulse, 0.01 * by_impulse);
}

TEST(RunningWorld, ARecordingHasEveryTickWhenItIsFinished) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "running_world.csv";
    RunningWorld world(settings(), false, Pose{}, {});
    StandInDevice hand;
    ProxyDescription description;
    description.device = world.session().add_device(hand, {}).handle;
    const SessionHandle proxy = world.session().add_proxy(description).handle;
    std::shared_ptr<Recording> recording =
        Recording::open({file.string(), "", 1.0}, [](const std::string& why) { ADD_FAILURE() << why; });
    EXPECT_EQ(world.record(recording), "");
    world.listeners().listen(world.session(), 1, recording->ring(), proxy, no_handle);
    world.advance(0.02);
    world.finish_recording();
    EXPECT_EQ(world.recording(), nullptr);
    EXPECT_EQ(recording->rows(), 20u);
    world.advance(0.02);
    EXPECT_EQ(recording->rows(), 20u);
    recording.reset();
    std::filesystem::remove(file);
}

TEST(RunningWorld, OneThatHasEndedHoldsNoRecording) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "ended_world.csv";
    RunningWorld world(settings(), false, Pose{}, {});
    std::shared_ptr<Recording> recording = Recording::open({file.string(), "", 1.0}, [](const auto&) {});
    world.record(recording);
    world.end();
    EXPECT_TRUE(world.is_over());
    EXPECT_EQ(recording.use_count(), 1) << "whoever closes its files would wait for the world to go";
    recording.reset();
    std::filesystem::remove(file);
}

// Two worlds of one program that are linked.
struct Pair {
    static LinkPlan plan(bool is_operator, const std::shared_ptr<MemoryLinkPair>& wire) {
        LinkPlan plan;
        plan.is_operator = is_operator;
        plan.scenario = model_mediated;
        plan.revision = 1;
        plan.wire = wire;
        return plan;
    }
    void frame() {
        for (RunningWorld* world : {&here, &there}) {
            world->synchronise(*world->links().front(), plan(world == &here, wire), Vec3(0.0));
        }
        bodies.synchronise({there.session(), Workers::shared(), {}, 0.01, there.loop().ticks() + 1, 0});
        tell(bodies, there.links(), there.session().snapshot(), there.loop().now());
        here.advance(0.01);
        there.advance(0.01);
        there.session().refresh();
    }

    std::shared_ptr<MemoryLinkPair> wire = std::make_shared<MemoryLinkPair>();
    RunningWorld here{settings(), false, Pose{}, {plan(true, wire)}};
    RunningWorld there{settings(), false, Pose{}, {plan(false, wire)}};
    shared::Prop box = shared::box_prop(1, 0.5);
    BodyMirrors bodies{8, false};
};

TEST(RunningWorld, AFarSideIsToldOfTheSceneByItsPaths) {
    Pair pair;
    EXPECT_TRUE(pair.here.is_operator());
    EXPECT_FALSE(pair.there.is_operator());
    pair.bodies.match(
        {1}, [&](std::uint64_t) { return std::make_unique<shared::PlayedBody>(pair.box); }, {}, {},
        pair.there.session());
    for (int i = 0; i < 60; ++i) {
        pair.frame();
    }
    const std::vector<ModelObject>& objects = pair.here.links().front()->objects();
    ASSERT_EQ(objects.size(), 1u);
    EXPECT_EQ(objects.front().name, "path 1");
}

TEST(RunningWorld, OneThatEndsTakesItsLeave) {
    Pair pair;
    for (int i = 0; i < 60; ++i) {
        pair.frame();
    }
    ASSERT_EQ(pair.here.links().front()->report().state, LinkState::connected);
    pair.there.end();
    pair.here.advance(0.01);
    pair.here.synchronise(*pair.here.links().front(), Pair::plan(true, pair.wire), Vec3(0.0));
    EXPECT_EQ(pair.here.links().front()->report().state, LinkState::left);
}

}  // namespace
}  // namespace tactus::running_world_test
