#include "core/haptics/touch_scene.hpp"

#include <gtest/gtest.h>

#include "shared/meshes.hpp"
#include "shared/poses.hpp"
#include "shared/random_values.hpp"

namespace tactus::touch_scene_test {
namespace {

using shared::at;

std::shared_ptr<const TouchShape> spheres(int count) {
    std::vector<PlacedShape> placed;
    for (int i = 0; i < count; ++i) {
        placed.push_back({SphereShape{0.5}, {Vec3(2.0 * i, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}});
    }
    return make_touch_shape(placed).shape;
}

TEST(TouchScene, ABodyBringsItsPartsIntoTheWorld) {
    TouchScene scene(4, 8);
    const auto shape = spheres(2);
    const int body = scene.add(*shape, at({0.0, 1.0, 0.0}), {}, 1);
    ASSERT_GE(body, 0);
    const auto first = scene.body(body).first_part;
    EXPECT_EQ(scene.parts()[first].pose.position, Vec3(0.0, 1.0, 0.0));
    EXPECT_EQ(scene.parts()[first + 1].pose.position, Vec3(2.0, 1.0, 0.0));
}

TEST(TouchScene, AFullSceneRefuses) {
    TouchScene scene(2, 3);
    const auto shape = spheres(2);
    EXPECT_GE(scene.add(*shape, {}, {}, 1), 0);
    EXPECT_EQ(scene.add(*shape, {}, {}, 1), -1);  // no room for two more parts
    const auto single = spheres(1);
    EXPECT_GE(scene.add(*single, {}, {}, 1), 0);
    EXPECT_EQ(scene.add(*single, {}, {}, 1), -1);  // no body left
}

TEST(TouchScene, RemovedRoomIsUsedAgain) {
    TouchScene scene(3, 4);
    const auto pair = spheres(2);
    const int first = scene.add(*pair, {}, {}, 1);
    ASSERT_GE(scene.add(*pair, {}, {}, 1), 0);
    scene.remove(first);
    EXPECT_GE(scene.add(*pair, {}, {}, 1), 0);
}

TEST(TouchScene, MovedSaysSoForOneTick) {
    TouchScene scene(4, 8);
    const auto shape = spheres(1);
    const int body = scene.add(*shape, {}, {}, 1);
    scene.begin_tick();
    scene.set_pose(body, at({0.5, 0.0, 0.0}));
    EXPECT_TRUE(scene.body(body).moved);
    ASSERT_EQ(scene.moved_bodies().size(), 1u);
    EXPECT_EQ(scene.body(body).previous.position, Vec3(0.0));
    EXPECT_GE(scene.body(body).moved_by, 0.5);
    EXPECT_EQ(previous_place(scene.body(body), {1.0, 0.0, 0.0}), Vec3(0.5, 0.0, 0.0));
    scene.begin_tick();
    EXPECT_FALSE(scene.body(body).moved);
    EXPECT_TRUE(scene.moved_bodies().empty());
    EXPECT_EQ(scene.body(body).previous.position, Vec3(0.5, 0.0, 0.0));
    EXPECT_EQ(scene.parts()[scene.body(body).first_part].previous.position, Vec3(0.5, 0.0, 0.0));
}

TEST(TouchScene, MovedByBoundsTheWayOfEveryPoint) {
    shared::RandomValues random(81);
    const auto shape = spheres(3);
    for (int i = 0; i < 500; ++i) {
        TouchScene scene(1, 3);
        const Pose from{random.in_ball(2.0), random.rotation()};
        const Pose to{random.in_ball(2.0), random.rotation()};
        const int body = scene.add(*shape, from, {}, 1);
        scene.begin_tick();
        scene.set_pose(body, to);
        for (int k = 0; k < 20; ++k) {
            const Vec3 p = Vec3(2.0 * random.below(3), 0.0, 0.0) + random.in_ball(0.5);
            ASSERT_LE(glm::length(to_parent(to, p) - to_parent(from, p)),
                      scene.body(body).moved_by * (1.0 + 1e-12));
        }
    }
}

TEST(TouchScene, TwoPosesInOneTickAreOneMotionFromTheFirst) {
    TouchScene scene(1, 1);
    const auto shape = spheres(1);
    const int body = scene.add(*shape, {}, {}, 1);
    scene.begin_tick();
    scene.set_pose(body, at({1.0, 0.0, 0.0}));
    scene.set_pose(body, at({2.0, 0.0, 0.0}));
    EXPECT_EQ(scene.moved_bodies().size(), 1u);
    EXPECT_EQ(scene.body(body).previous.position, Vec3(0.0));
    EXPECT_GE(scene.body(body).moved_by, 2.0);
}

TEST(TouchScene, ATeleportIsNoMotionButVoidsWhatIsRemembered) {
    TouchScene scene(1, 1);
    const auto shape = spheres(1);
    const int body = scene.add(*shape, {}, {}, 1);
    const std::uint64_t before = scene.revision();
    scene.begin_tick();
    scene.set_pose(body, at({5.0, 0.0, 0.0}), true);
    EXPECT_FALSE(scene.body(body).moved);
    EXPECT_EQ(scene.body(body).previous.position, Vec3(5.0, 0.0, 0.0));
    EXPECT_NE(scene.revision(), before);
}

TEST(TouchScene, TheSamePoseIsNoMotion) {
    TouchScene scene(1, 1);
    const auto shape = spheres(1);
    const int body = scene.add(*shape, at({1.0, 0.0, 0.0}), {}, 1);
    scene.begin_tick();
    scene.set_pose(body, at({1.0, 0.0, 0.0}));
    EXPECT_TRUE(scene.moved_bodies().empty());
}

TEST(TouchScene, RemovingAMovedBodyForgetsItsMotion) {
    TouchScene scene(2, 2);
    const auto shape = spheres(1);
    const int body = scene.add(*shape, {}, {}, 1);
    scene.begin_tick();
    scene.set_pose(body, at({1.0, 0.0, 0.0}));
    scene.remove(body);
    EXPECT_TRUE(scene.moved_bodies().empty());
    scene.begin_tick();
}

TEST(TouchScene, ANarrowedBodyIsTheSameOneTouchedThroughAnotherShape) {
    TouchScene scene(2, 4);
    const PlacedShape lump{MeshShape{std::make_shared<const TriangleMesh>(shared::icosphere(1, 0.5))}, {}};
    const PlacedShape ball{SphereShape{0.5}, at({2.0, 0.0, 0.0})};
    const auto shape = make_touch_shape(std::vector{lump, ball}).shape;
    const int body = scene.add(*shape, at({0.0, 1.0, 0.0}), {}, 1);
    const std::uint64_t before = scene.revision();
    scene.begin_tick();
    const TouchShape narrower = *shape;
    ASSERT_TRUE(scene.narrow(body, narrower));
    const std::uint32_t first = scene.body(body).first_part;
    EXPECT_EQ(scene.body(body).shape, &narrower);
    EXPECT_EQ(scene.parts()[first].part, &narrower.parts[0]);
    EXPECT_EQ(scene.parts()[first + 1].part, &narrower.parts[1]);
    EXPECT_EQ(scene.parts()[first + 1].pose.position, Vec3(2.0, 1.0, 0.0));
    EXPECT_EQ(scene.revision(), before + 1) << "what is remembered of it is void";
    EXPECT_EQ(scene.change(before + 1).part_count, 2u);
    EXPECT_TRUE(scene.only_gives_since(before));
    EXPECT_EQ(scene.body(body).former, nullptr);
    EXPECT_TRUE(scene.deformed_bodies().empty());
}

TEST(TouchScene, OfOtherPartsABodyIsNotNarrowed) {
    TouchScene scene(1, 4);
    const PlacedShape lump{MeshShape{std::make_shared<const TriangleMesh>(shared::icosphere(1, 0.5))}, {}};
    const auto shape = make_touch_shape(std::vector{lump}).shape;
    const int body = scene.add(*shape, {}, {}, 1);
    const std::uint64_t before = scene.revision();
    EXPECT_FALSE(scene.narrow(body, *make_touch_shape(std::vector{lump}).shape)) << "another tree";
    EXPECT_FALSE(scene.narrow(body, *spheres(1))) << "no tree";
    TouchShape more = *shape;
    more.parts.push_back(spheres(1)->parts.front());
    EXPECT_FALSE(scene.narrow(body, more));
    EXPECT_EQ(scene.body(body).shape, shape.get());
    EXPECT_EQ(scene.revision(), before);
}

}  // namespace
}  // namespace tactus::touch_scene_test
