#include "world/scene_facts.hpp"

#include <gtest/gtest.h>

namespace tactus::scene_facts_test {
namespace {

BodyForm form_of(const Shape& shape) {
    BodyForm form;
    form.shapes = {PlacedShape{shape, Pose{}}};
    return form;
}

SceneFacts facts_of(std::initializer_list<double> reaches) {
    SceneFacts facts;
    for (const double reach : reaches) {
        facts.add(1, reach);
    }
    return facts;
}

bool says(const std::string& text, const char* words) {
    return text.find(words) != std::string::npos;
}

TEST(SceneFacts, AFingertipThatFitsHasNoProblem) {
    EXPECT_EQ(problem_of_fingertip(0.01, 1, facts_of({0.1, 2.0})), "");
    EXPECT_EQ(problem_of_fingertip(0.01, 1, {}), "") << "nothing is there yet";
}

TEST(SceneFacts, AnEmptyMaskAndOneOfOtherLayersTouchNothing) {
    EXPECT_TRUE(says(problem_of_fingertip(0.01, 0, {}), "'collision_mask' is empty"));
    EXPECT_TRUE(says(problem_of_fingertip(0.01, 4, facts_of({0.1})), "no layer that a body"));
}

TEST(SceneFacts, AFingertipLargerThanAllOrASpeckIsSaid) {
    EXPECT_TRUE(says(problem_of_fingertip(3.0, 1, facts_of({0.1, 2.0})), "radius of 3 m does not fit"));
    EXPECT_TRUE(says(problem_of_fingertip(1e-6, 1, facts_of({0.1})), "does not fit"));
}

TEST(SceneFacts, APlaneHasNoSize) {
    EXPECT_EQ(problem_of_fingertip(30.0, 1, facts_of({std::numeric_limits<double>::infinity()})), "");
}

TEST(SceneFacts, ReachOfShapesAndOfMeshes) {
    EXPECT_NEAR(reach_of(form_of(SphereShape{0.25})), 0.25, 1e-12);
    BodyForm form;
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, 2}};
    mesh.triangles = {{0, 2, 1}};
    const auto source = std::make_shared<TriangleSource>([mesh] { return mesh; }, 1);
    form.meshes = {MeshDraft{source, Mat3(2.0), Pose{}, 0.0, false, {}}};
    EXPECT_NEAR(reach_of(form), 4.0, 1e-12);
}

TEST(SceneFacts, AHandInsideASolidIsFoundAndOneThatTouchesItIsNot) {
    const BodyForm box = form_of(BoxShape{Vec3(0.5)});
    EXPECT_TRUE(is_inside(box, Pose{}, Vec3(0.0), 0.01));
    EXPECT_TRUE(is_inside(box, Pose{}, Vec3(0.0, 0.505, 0.0), 0.01));
    EXPECT_FALSE(is_inside(box, Pose{}, Vec3(0.0, 0.51, 0.0), 0.01)) << "it lies on the box";
    EXPECT_FALSE(is_inside(box, Pose{Vec3(5.0, 0.0, 0.0)}, Vec3(0.0), 0.01));
}

}  // namespace
}  // namespace tactus::scene_facts_test
