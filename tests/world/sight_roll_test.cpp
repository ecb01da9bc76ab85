#include "world/sight_roll.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"

namespace tactus::sight_roll_test {
namespace {

SightedObject object(std::uint64_t id, SightState state = SightState::tracked, std::int32_t mesh = 0) {
    SightedObject seen;
    seen.id = id;
    seen.mesh = mesh;
    seen.state = state;
    seen.pose.position = {0.1, 0.2, 0.3};
    return seen;
}

Sight sight_of(std::span<const SightedObject> objects) {
    Sight sight;
    sight.objects = objects;
    return sight;
}

TEST(SightRoll, WhatMovesIsWhereItMustBeByNow) {
    SightedObject seen = object(1);
    EXPECT_EQ(pose_after(seen, 1.0).position, seen.pose.position);
    seen.linear_velocity = {1.0, 0.0, 0.0};
    seen.angular_velocity = {0.0, 1.0, 0.0};
    EXPECT_NEAR(pose_after(seen, 0.5).position.x, 0.6, 1e-12);
    EXPECT_NEAR(angle_between(pose_after(seen, 0.5).rotation, seen.pose.rotation), 0.5, 1e-9);
}

TEST(SightRoll, ChangesAreToldOnce) {
    using Kind = SightChange::Kind;
    SightChanges changes;
    const auto kinds = [&changes](const std::vector<SightedObject>& objects) {
        std::vector<Kind> told;
        for (const SightChange& change : changes.since_last(sight_of(objects))) {
            told.push_back(change.kind);
        }
        return told;
    };
    EXPECT_EQ(kinds({object(1)}), std::vector{Kind::found});
    EXPECT_EQ(kinds({object(1)}), std::vector{Kind::updated});
    EXPECT_EQ(kinds({object(1, SightState::lost)}), std::vector{Kind::lost});
    EXPECT_TRUE(kinds({object(1, SightState::lost)}).empty());
    EXPECT_EQ(kinds({object(1)}), std::vector{Kind::found});
    EXPECT_EQ(kinds({}), std::vector{Kind::lost}) << "gone without a word";
    EXPECT_TRUE(kinds({}).empty());
}

TEST(SightRoll, EachObjectHasOneNodeThatLooksLikeIt) {
    SightRoll roll;
    std::uint64_t next = 1;
    std::vector<std::uint64_t> hidden;
    const auto show = [&next](const SightedObject&) { return next++; };
    const auto hide = [&hidden](std::uint64_t node) { hidden.push_back(node); };
    const auto update = [&](const std::vector<SightedObject>& objects) {
        roll.update(sight_of(objects), show, hide);
    };
    update({object(7), object(8)});
    update({object(7), object(8)});
    EXPECT_EQ(roll.node_of(7), 1u);
    EXPECT_EQ(roll.node_of(8), 2u);
    EXPECT_TRUE(hidden.empty());
    update({object(7, SightState::tracked, 1), object(8, SightState::lost)});
    EXPECT_EQ(roll.node_of(7), 3u) << "it looks otherwise";
    EXPECT_EQ(roll.node_of(8), 0u);
    EXPECT_EQ(hidden, (std::vector<std::uint64_t>{1, 2}));
    roll.hide_all(hide);
    EXPECT_EQ(hidden.back(), 3u);
    EXPECT_EQ(roll.node_of(7), 0u);
}

TEST(SightRoll, TheSupportIsElsewhereWhereNoNoiseExplainsIt) {
    SupportPlane before;
    EXPECT_TRUE(is_elsewhere(before, before)) << "nothing was seen before";
    before.is_found = true;
    SupportPlane now = before;
    now.offset = 0.0015;
    EXPECT_FALSE(is_elsewhere(now, before));
    now.offset = 0.0025;
    EXPECT_TRUE(is_elsewhere(now, before));
    now.offset = 0.0;
    now.normal = turn_by({0.02, 0.0, 0.0}, 1.0) * before.normal;
    EXPECT_TRUE(is_elsewhere(now, before));
}

TEST(SightRoll, ACameraIsPutWhereThePlaneOrAnObjectSays) {
    Sight sight;
    EXPECT_FALSE(camera_over_plane(sight, 0.0));
    sight.camera = {{0.0, 0.7, 0.5}, turn_by({-0.9, 0.0, 0.0}, 1.0)};
    sight.plane.is_found = true;
    sight.plane.normal = turn_by({0.05, 0.0, 0.02}, 1.0) * Vec3(0.0, 1.0, 0.0);
    sight.plane.offset = 0.03;
    const std::optional<Pose> over = camera_over_plane(sight, 0.4);
    ASSERT_TRUE(over);
    const Pose moved = compose(*over, inverse(sight.camera));
    EXPECT_LT(glm::distance(moved.rotation * sight.plane.normal, Vec3(0.0, 1.0, 0.0)), 1e-9);
    EXPECT_NEAR(to_parent(moved, sight.plane.offset * sight.plane.normal).y, 0.4, 1e-9);

    const std::vector<SightedObject> objects = {object(3)};
    sight.objects = objects;
    EXPECT_FALSE(camera_by_object(sight, 4, {}));
    const Pose place{{1.0, 2.0, 3.0}, turn_by({0.0, 0.4, 0.0}, 1.0)};
    const std::optional<Pose> by = camera_by_object(sight, 3, place);
    ASSERT_TRUE(by);
    const Pose in_camera = compose(inverse(sight.camera), objects[0].pose);
    EXPECT_LT(glm::distance(compose(*by, in_camera).position, place.position), 1e-12);
}

TEST(SightRoll, ASlabLiesWithItsUpperSideInThePlane) {
    SupportPlane plane;
    plane.normal = glm::normalize(Vec3(0.1, 1.0, -0.2));
    plane.offset = 0.7;
    const Pose slab = slab_under(plane, 0.04);
    EXPECT_LT(glm::distance(slab.rotation * Vec3(0.0, 1.0, 0.0), plane.normal), 1e-12);
    const Vec3 top = to_parent(slab, Vec3(0.3, 0.02, -0.4));
    EXPECT_NEAR(glm::dot(plane.normal, top), plane.offset, 1e-12);
}

TEST(SightRoll, TheLeastBelievedIsTold) {
    EXPECT_EQ(lowest_confidence({}), 0.0);
    std::vector<SightedObject> objects{object(1), object(2), object(3)};
    objects[0].confidence = 0.9;
    objects[1].confidence = 0.4;
    objects[2].confidence = 0.7;
    EXPECT_EQ(lowest_confidence(sight_of(objects)), 0.4);
}

TEST(SightRoll, EveryStateHasAWord) {
    EXPECT_STREQ(word_of(SightState::found), "found");
    EXPECT_STREQ(word_of(SightState::tracked), "tracked");
    EXPECT_STREQ(word_of(SightState::cut), "cut");
    EXPECT_STREQ(word_of(SightState::hidden), "hidden");
    EXPECT_STREQ(word_of(SightState::lost), "lost");
}

}  // namespace
}  // namespace tactus::sight_roll_test
