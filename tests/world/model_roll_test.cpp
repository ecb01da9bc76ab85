// The objects of a far side and the nodes that show them.
#include "world/model_roll.hpp"

#include <gtest/gtest.h>

namespace tactus::model_roll_test {
namespace {

// Shows each object as a node with the next number.
struct Stage {
    std::uint64_t next = 100;
    std::vector<std::uint64_t> hidden;
    std::uint64_t freed = 0;  // a node of it that is gone
    ModelRoll roll;

    std::vector<ModelNews> update(const std::vector<ModelObject>& objects) {
        return roll.update(
            objects,
            [this](const std::string&, const ModelRoll::Form&) { return ModelRoll::Shown{.node = next++}; },
            [this](const ModelRoll::Shown& shown) { hidden.push_back(shown.node); },
            [this](const std::string&, const ModelRoll::Shown& shown) { return shown.node != freed; });
    }
};

ModelObject object(ObjectId id, const char* name, SessionHandle body, const char* problem = "") {
    return {id, name, body, problem, false};
}

TEST(ModelRoll, ShowsWhatIsNewAndLeavesWhatIsKnown) {
    Stage stage;
    const auto first = stage.update({object(1, "Box", 7)});
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].kind, ModelNews::Kind::discovered);
    EXPECT_EQ(first[0].name, "Box");
    EXPECT_EQ(first[0].node, 100u);
    EXPECT_TRUE(stage.update({object(1, "Box", 7)}).empty());
    EXPECT_EQ(stage.roll.node_of(7), 100u);
    EXPECT_EQ(stage.roll.body_of(100), 7u);
    EXPECT_TRUE(stage.hidden.empty());
}

TEST(ModelRoll, ShowsAnewWhatIsAnotherBodyByNow) {
    Stage stage;
    stage.update({object(1, "Box", 7)});
    const auto news = stage.update({object(1, "Box", 8)});
    ASSERT_EQ(news.size(), 1u);
    EXPECT_EQ(news[0].kind, ModelNews::Kind::discovered);
    EXPECT_EQ(stage.hidden, std::vector<std::uint64_t>{100});
    EXPECT_EQ(stage.roll.node_of(7), 0u);
    EXPECT_EQ(stage.roll.node_of(8), 101u);
}

TEST(ModelRoll, ShowsAnewWhatHasLostItsNode) {
    Stage stage;
    stage.update({object(1, "Box", 7), object(2, "Ball", 9)});
    stage.freed = 100;
    const auto news = stage.update({object(1, "Box", 7), object(2, "Ball", 9)});
    ASSERT_EQ(news.size(), 1u);
    EXPECT_EQ(news[0].kind, ModelNews::Kind::discovered);
    EXPECT_EQ(news[0].node, 102u);
    EXPECT_EQ(stage.roll.node_of(7), 102u);
    EXPECT_EQ(stage.roll.node_of(9), 101u);
    EXPECT_TRUE(stage.update({object(1, "Box", 7), object(2, "Ball", 9)}).empty()) << "once";
}

TEST(ModelRoll, AsksForNoNodeOfWhatCouldNotBeBuilt) {
    Stage stage;
    stage.update({object(1, "Box", no_handle, "it has no shape")});
    stage.freed = 0;
    EXPECT_TRUE(stage.update({object(1, "Box", no_handle, "it has no shape")}).empty());
}

TEST(ModelRoll, HidesWhatIsGone) {
    Stage stage;
    stage.update({object(1, "Box", 7), object(2, "Ball", 9)});
    const auto news = stage.update({object(2, "Ball", 9)});
    ASSERT_EQ(news.size(), 1u);
    EXPECT_EQ(news[0].kind, ModelNews::Kind::removed);
    EXPECT_EQ(news[0].name, "Box");
    EXPECT_EQ(stage.hidden, std::vector<std::uint64_t>{100});
    EXPECT_EQ(stage.roll.shown(7), nullptr);
    EXPECT_EQ(stage.roll.size(), 1u);
}

TEST(ModelRoll, SaysOnceWhatCouldNotBeBuilt) {
    Stage stage;
    const auto news = stage.update({object(1, "Box", no_handle, "it has no shape")});
    ASSERT_EQ(news.size(), 1u);
    EXPECT_EQ(news[0].kind, ModelNews::Kind::refused);
    EXPECT_EQ(news[0].why, "it has no shape");
    EXPECT_EQ(stage.next, 100u) << "nothing is shown of it";
    EXPECT_TRUE(stage.update({object(1, "Box", no_handle, "it has no shape")}).empty());
}

TEST(ModelRoll, IsShownInTheFormThatWasDescribed) {
    ModelRoll roll;
    ObjectDescription description;
    description.object = 3;
    description.body.shapes = {PlacedShape{SphereShape{0.5}, Pose{}}};
    description.body.pose.position = Vec3(1, 2, 3);
    roll.note(description);
    ModelRoll::Form seen;
    roll.update(
        {object(3, "Ball", 4)},
        [&seen](const std::string&, const ModelRoll::Form& form) {
            seen = form;
            return ModelRoll::Shown{.node = 5};
        },
        [](const ModelRoll::Shown&) {}, [](const std::string&, const ModelRoll::Shown&) { return true; });
    EXPECT_EQ(seen.pose.position, Vec3(1, 2, 3));
    EXPECT_EQ(seen.touched.size(), 1u);
}

}  // namespace
}  // namespace tactus::model_roll_test
