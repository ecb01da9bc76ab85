// Meshes that follow bones and blend shapes.
#include "world/skinned_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/tree/triangle_tree.hpp"

namespace tactus::skinned_mesh_test {
namespace {

SceneFrame turned(double angle, const Vec3& origin = Vec3(0.0)) {
    return {glm::mat3_cast(glm::angleAxis(angle, Vec3(0.0, 0.0, 1.0))), origin};
}

// Two triangles that share an edge, each with corners of its own there: the left follows the bone 0, the
// right one the bone 1, and the edge both alike.
SkinCollector::Surface flap() {
    SkinCollector::Surface surface;
    surface.corners = {{-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, -1, 0}, {0, 1, 0}, {1, 0, 0}};
    surface.bones = {0, 0, 0, 1, 0, 1, 0, 1, 0, 1, 1, 0};
    surface.weights = {1, 0, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 1, 0};
    surface.shapes = {std::vector<Vec3>(6, Vec3(0.0, 0.0, 0.5))};
    return surface;
}

SkinnedMesh collected(const SkinCollector::Surface& surface) {
    SkinCollector collector;
    collector.add(surface);
    return collector.take();
}

TEST(SkinnedMesh, CornersAtOnePlaceAreOneAndTrianglesTurnOver) {
    const SkinnedMesh mesh = collected(flap());
    EXPECT_EQ(mesh.rest.vertices.size(), 4u);
    ASSERT_EQ(mesh.rest.triangles.size(), 2u);
    EXPECT_EQ(mesh.rest.triangles[0], (std::array<std::uint32_t, 3>{0, 2, 1}));
    EXPECT_EQ(mesh.rest.triangles[1], (std::array<std::uint32_t, 3>{2, 3, 1}));
    EXPECT_EQ(mesh.influences, 2u);
}

TEST(SkinnedMesh, AtRestItIsTheMeshItself) {
    const SkinnedMesh mesh = collected(flap());
    EXPECT_EQ(posed(mesh, {{SceneFrame{}, SceneFrame{}}, {0.0}, {}}).vertices, mesh.rest.vertices);
}

TEST(SkinnedMesh, EachCornerGoesWhereItsBonesTakeIt) {
    const SkinnedMesh mesh = collected(flap());
    const SkinPose pose{{SceneFrame{}, turned(0.4, {0.0, 0.2, 0.0})}, {0.0}, {}};
    const TriangleMesh now = posed(mesh, pose);
    EXPECT_EQ(now.vertices[0], Vec3(-1, 0, 0));
    const auto taken = [&](const Vec3& at) { return pose.bones[1].axes * at + pose.bones[1].origin; };
    EXPECT_LT(glm::distance(now.vertices[3], taken({1, 0, 0})), 1e-12);
    EXPECT_LT(glm::distance(now.vertices[1], 0.5 * (Vec3(0, 1, 0) + taken({0, 1, 0}))), 1e-12);
    EXPECT_EQ(now.triangles, mesh.rest.triangles);
}

TEST(SkinnedMesh, BlendShapesComeBeforeBonesAndThePlaceAfterThem) {
    const SkinnedMesh mesh = collected(flap());
    const SkinPose pose{{SceneFrame{}, SceneFrame{}}, {2.0}, {Mat3(3.0), {1.0, 0.0, 0.0}}};
    EXPECT_LT(glm::distance(posed(mesh, pose).vertices[3], Vec3(4.0, 0.0, 3.0)), 1e-12);
}

TEST(SkinnedMesh, WhatFollowsNothingStaysAndBonesThatAreNotThereAreLeftOut) {
    SkinCollector::Surface surface = flap();
    surface.weights[0] = 0.0f;  // of the first corner: it follows nothing
    surface.bones[10] = 7;      // of the last
    const SkinnedMesh mesh = collected(surface);
    const TriangleMesh now = posed(mesh, {{turned(0.3), turned(0.3)}, {}, {}});
    EXPECT_EQ(now.vertices[0], Vec3(-1, 0, 0));
    EXPECT_EQ(now.vertices[3], Vec3(1, 0, 0));
    surface.bones.pop_back();  // not as many as weights
    EXPECT_EQ(collected(surface).influences, 0u);
}

TEST(SkinnedMesh, FromOnePoseToTheNextTheTreeIsRefitted) {
    const auto mesh = std::make_shared<const SkinnedMesh>(collected(flap()));
    const auto before = source_of(mesh, {{SceneFrame{}, SceneFrame{}}, {0.0}, {}});
    const BuiltMesh first = before->built(Mat3(1.0), run_serially);
    const auto now = source_of(mesh, {{SceneFrame{}, turned(0.2)}, {0.3}, {}});
    now->succeed(before);
    EXPECT_TRUE(now->built(Mat3(1.0), run_serially).tree->is_refit_of(*first.tree));
}

}  // namespace
}  // namespace tactus::skinned_mesh_test
