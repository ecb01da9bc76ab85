// Large meshes are touched as soon as they are there; what fingertips cannot touch of them is left out later.
#include "world/narrowed_touch.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <future>
#include <thread>

#include "core/geometry/surface_query.hpp"
#include "core/tree/triangle_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/played_scene.hpp"
#include "shared/rough_meshes.hpp"

namespace tactus::narrowed_touch_test {
namespace {

using shared::box_prop;
using shared::PlayedBody;
using shared::Prop;

constexpr double fingertip = 0.1;

class HeldHand final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        DeviceSample sample;
        sample.position = position;
        sample.connected = true;
        return sample;
    }
    void write(Nanoseconds, const Vec3&) override {}

    Vec3 position{0.0};
};

// Goes on once the promise is kept, or gone.
std::function<void()> wait_for(std::promise<void>& promise) {
    return [kept = promise.get_future().share()] { kept.wait(); };
}

std::shared_ptr<TriangleSource> source_of(
    const TriangleMesh& mesh, const std::function<void()>& before = [] {}) {
    const auto triangles = [mesh, before] {
        before();
        return mesh;
    };
    return std::make_shared<TriangleSource>(triangles, mesh.triangles.size());
}

struct Scene {
    explicit Scene(bool in_turn) : mirrors(16, in_turn), session(settings()) {}
    static SessionSettings settings() {
        SessionSettings settings;
        settings.max_bodies = 16;
        settings.physics.gravity = Vec3(0.0);
        return settings;
    }

    Prop& add(const std::shared_ptr<TriangleSource>& source, const Vec3& place = Vec3(0.0)) {
        Prop prop = box_prop(props.size() + 1);
        prop.frame.origin = place;
        prop.form.shapes.clear();
        prop.form.meshes = {MeshDraft{source, Mat3(1.0), Pose{}, 0.0, false, ""}};
        prop.values.motion = Motion::Static;
        props.push_back(std::move(prop));
        has_changed = true;
        return props.back();
    }
    void change(Prop& prop, const std::shared_ptr<TriangleSource>& source) {
        prop.form.meshes.front().source = source;
        mirrors.news()->changed.push_back(prop.id);
    }
    void frame() {
        session.collect();
        if (std::exchange(has_changed, false)) {
            std::vector<std::uint64_t> bodies;
            for (const Prop& prop : props) {
                if (prop.is_there) {
                    bodies.push_back(prop.id);
                }
            }
            const auto make = [this](std::uint64_t id) {
                return std::make_unique<PlayedBody>(props[id - 1]);
            };
            mirrors.match(bodies, make, {}, nullptr, session);
        }
        mirrors.synchronise({.session = session,
                             .workers = workers,
                             .defaults = {},
                             .takes_effect = ticks + 1,
                             .touch_radius = radius});
        session.tick(static_cast<Nanoseconds>(ticks++) * 1'000'000);
        session.refresh();
    }
    // A frame, and another one when the workers have done what it has given them.
    void frames() {
        frame();
        workers.wait();
        frame();
    }
    const TouchableTriangles* touchable(std::uint64_t id = 1) const {
        const TouchShape* const touch = mirrors.of(id)->twin().touch();
        return touch != nullptr ? touch->parts.front().touchable.get() : nullptr;
    }
    bool is_there(std::uint64_t id = 1) const { return mirrors.of(id)->handle() != no_handle; }

    Workers workers;
    std::deque<Prop> props;
    BodyMirrors mirrors;
    Session session;
    std::uint64_t ticks = 0;
    double radius = fingertip;
    bool has_changed = true;
};

TEST(NarrowedTouch, SteppedTimeWaitsForIt) {
    Scene scene(false);
    scene.add(source_of(shared::rough_sphere(4, 0.5, 1.0)));
    scene.frame();
    ASSERT_NE(scene.touchable(), nullptr);
    EXPECT_EQ(scene.touchable()->radius, touchable_share * fingertip);
    EXPECT_LT(scene.touchable()->tree->triangle_count(),
              scene.mirrors.of(1)->twin().touch()->parts.front().tree()->triangle_count());
}

TEST(NarrowedTouch, InRealTimeTheMeshIsThereFirst) {
    Scene scene(true);
    std::promise<void> building, narrowing;
    scene.add(source_of(shared::rough_sphere(4, 0.5, 1.0), wait_for(building)));
    scene.frame();
    EXPECT_FALSE(scene.is_there());
    building.set_value();
    scene.workers.wait();
    scene.workers.add_later(wait_for(narrowing));
    scene.frame();
    EXPECT_TRUE(scene.is_there());
    EXPECT_EQ(scene.mirrors.building(), 0u);
    EXPECT_FALSE(scene.mirrors.of(1)->twin().is_building()) << "it can be touched";
    EXPECT_TRUE(scene.mirrors.of(1)->twin().is_narrowing());
    EXPECT_EQ(scene.touchable(), nullptr);
    narrowing.set_value();
    scene.workers.wait();
    scene.frame();
    EXPECT_NE(scene.touchable(), nullptr);
    EXPECT_FALSE(scene.mirrors.of(1)->twin().is_narrowing());
}

TEST(NarrowedTouch, WhatIsTouchedIsTheSame) {
    Scene scene(false);
    scene.radius = 0.0;
    scene.add(source_of(shared::rough_sphere(4, 0.5, 1.0)));
    HeldHand hand;
    hand.position = {0.1, 0.8, 0.0};
    ProxyDescription pointer;
    pointer.device = scene.session.add_device(hand, {}).handle;
    pointer.settings.radius = fingertip;
    scene.session.add_proxy(pointer);
    const auto settled = [&] {
        for (int i = 0; i < 40; ++i) {
            scene.frame();
        }
        return scene.session.snapshot().proxies[0];
    };
    const auto nearest = [&] {
        return nearest_surface(*scene.mirrors.of(1)->twin().touch(), Pose{}, {0.1, 0.6, 0.3}, 1.0).point;
    };
    settled();
    hand.position = {0.1, 0.4, 0.05};
    const ProxyState before = settled();
    const Vec3 nearest_before = nearest();
    ASSERT_EQ(scene.touchable(), nullptr);
    scene.radius = fingertip;
    const ProxyState after = settled();
    ASSERT_NE(scene.touchable(), nullptr);
    EXPECT_GT(before.contact_count, 0u);
    EXPECT_LT(glm::distance(before.position, after.position), 1e-4 * fingertip);
    EXPECT_EQ(nearest(), nearest_before) << "queries see the whole mesh";
}

TEST(NarrowedTouch, ASmallerFingertipNarrowsAnewALargerOneDoesNot) {
    for (const bool in_turn : {false, true}) {
        Scene scene(in_turn);
        scene.radius = 0.0;
        scene.add(source_of(shared::rough_sphere(4, 0.5, 1.0)));
        scene.frames();
        scene.frames();
        EXPECT_EQ(scene.touchable(), nullptr) << "nobody touches";
        scene.radius = fingertip;
        scene.frames();
        const TouchableTriangles* const first = scene.touchable();
        ASSERT_NE(first, nullptr);
        scene.radius = 2.0 * fingertip;
        scene.frames();
        EXPECT_EQ(scene.touchable(), first);
        scene.radius = 0.7 * fingertip;
        scene.frames();
        ASSERT_NE(scene.touchable(), nullptr);
        EXPECT_EQ(scene.touchable()->radius, touchable_share * 0.7 * fingertip);
    }
}

TEST(NarrowedTouch, BodiesOfOneMeshShareIt) {
    Scene scene(false);
    const auto source = source_of(shared::rough_sphere(4, 0.5, 1.0));
    scene.add(source);
    scene.add(source, {2.0, 0.0, 0.0});
    scene.frames();
    ASSERT_NE(scene.touchable(1), nullptr);
    EXPECT_EQ(scene.touchable(2), scene.touchable(1));
    scene.add(source, {4.0, 0.0, 0.0});
    scene.props.front().makings.mass = 2.0;
    scene.frames();
    EXPECT_NE(scene.touchable(1), nullptr);
    EXPECT_EQ(scene.touchable(1), scene.touchable(2));
    EXPECT_EQ(scene.touchable(3), scene.touchable(2));
}

TEST(NarrowedTouch, ABodyThatDeformsIsLeftAlone) {
    for (const bool in_turn : {false, true}) {
        Scene scene(in_turn);
        TriangleMesh mesh = shared::rough_sphere(4, 0.5, 1.0);
        const auto source = source_of(mesh);
        Prop& prop = scene.add(source);
        scene.frames();
        scene.frames();
        ASSERT_NE(scene.touchable(), nullptr);
        const SessionHandle handle = scene.mirrors.of(1)->handle();
        for (Vec3& corner : mesh.vertices) {
            corner *= 0.99;
        }
        const auto other = source_of(mesh);
        other->succeed(source);
        scene.change(prop, other);
        scene.frames();
        scene.frames();
        EXPECT_EQ(scene.mirrors.of(1)->handle(), handle) << "a deformation";
        EXPECT_EQ(scene.touchable(), nullptr);
        scene.radius = 0.5 * fingertip;
        scene.frames();
        EXPECT_EQ(scene.touchable(), nullptr);
        EXPECT_FALSE(scene.mirrors.of(1)->twin().is_narrowing());
    }
}

// Before the workers have come to it, or while they are at it.
TEST(NarrowedTouch, WhatIsGoneMeanwhileIsNotNarrowed) {
    Scene scene(true);
    std::promise<void> built, building, narrowing;
    Prop& prop = scene.add(source_of(shared::rough_sphere(4, 0.5, 1.0), wait_for(built)));
    scene.frame();
    built.set_value();
    scene.workers.wait();
    scene.workers.add_later(wait_for(narrowing));
    scene.frame();
    ASSERT_TRUE(scene.mirrors.of(1)->twin().is_narrowing());
    scene.change(prop, source_of(shared::scanned(4), wait_for(building)));
    scene.frame();
    EXPECT_FALSE(scene.mirrors.of(1)->twin().is_narrowing());
    building.set_value();
    narrowing.set_value();
    scene.frames();
    EXPECT_TRUE(scene.is_there());
    prop.is_there = false;
    scene.has_changed = true;
    scene.frames();
    EXPECT_EQ(scene.mirrors.of(1), nullptr);
}

// Whoever asks again, while the workers are at it for nobody, gets all of it.
TEST(NarrowedTouch, WhatIsGivenUpIsBegunAnew) {
    const PlacedShape placed{MeshShape{std::make_shared<TriangleMesh>(shared::rough_sphere(5, 0.5, 1.0))},
                             {}};
    const auto shape = make_touch_shape({&placed, 1}).shape;
    Workers workers;
    NarrowedTrees trees;
    for (int i = 0; i < 20; ++i) {
        for (int k = 0; k < i; ++k) {
            trees.get(shape->parts.front(), fingertip, workers);
            std::this_thread::yield();
        }
        const auto tree = trees.get(shape->parts.front(), fingertip, workers);
        workers.wait();
        ASSERT_TRUE(tree->done);
        ASSERT_NE(tree->touchable, nullptr);
        EXPECT_EQ(tree->touchable->tree->triangle_count(),
                  touchable_slots(*shape->parts.front().tree(), touchable_share * fingertip).size());
    }
}

TEST(NarrowedTouch, AFewTrianglesAreLeftAsTheyAre) {
    Scene scene(false);
    scene.add(source_of(shared::rough_sphere(2, 0.5, 1.0)));
    scene.frames();
    EXPECT_TRUE(scene.is_there());
    EXPECT_EQ(scene.touchable(), nullptr);
}

}  // namespace
}  // namespace tactus::narrowed_touch_test
