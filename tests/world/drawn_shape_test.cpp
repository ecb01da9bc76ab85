#include "world/drawn_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <numbers>

namespace tactus {
namespace {

// Six times the volume, positive where all triangles run counter-clockwise seen from outside.
double volume(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += glm::dot(mesh.vertices[a], glm::cross(mesh.vertices[b], mesh.vertices[c]));
    }
    return sum / 6.0;
}

TEST(DrawnShape, SolidsHaveTheirVolumeAndAreSeenFromOutside) {
    const double pi = std::numbers::pi;
    EXPECT_NEAR(volume(drawn_shape(BoxShape{Vec3(1.0, 2.0, 3.0)}).mesh), 48.0, 1e-12);
    EXPECT_NEAR(volume(drawn_shape(SphereShape{1.0}).mesh), 4.0 / 3.0 * pi, 0.07);
    EXPECT_NEAR(volume(drawn_shape(CylinderShape{1.0, 1.0}).mesh), 2.0 * pi, 0.03);
    EXPECT_NEAR(volume(drawn_shape(CapsuleShape{1.0, 1.0}).mesh), (2.0 + 4.0 / 3.0) * pi, 0.1);
}

TEST(DrawnShape, ThePlaneLiesInItselfAndFacesOutwards) {
    const Vec3 normal = glm::normalize(Vec3(1.0, 2.0, 3.0));
    const TriangleMesh mesh = drawn_shape(PlaneShape{normal, 0.5}).mesh;
    for (const auto& [a, b, c] : mesh.triangles) {
        EXPECT_NEAR(glm::dot(mesh.vertices[a], normal), 0.5, 1e-12);
        const Vec3 facing =
            glm::cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
        EXPECT_GT(glm::dot(facing, normal), 0.0);
    }
}

TEST(Tube, GoesAlongItsPointsAndIsSeenFromOutside) {
    const std::vector<Vec3> points = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}};
    const TriangleMesh mesh = tube(points, 0.2, false).mesh;
    for (const Vec3& vertex : mesh.vertices) {
        EXPECT_NEAR(glm::length(Vec3(vertex.x, vertex.y, 0.0)), 0.1, 1e-12);
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3& p = mesh.vertices[a];
        const Vec3 facing = glm::cross(mesh.vertices[b] - p, mesh.vertices[c] - p);
        EXPECT_GT(glm::dot(facing, Vec3(p.x, p.y, 0.0)), 0.0);
    }
}

TEST(Tube, AClosedOneComesBackAndAPointIsNone) {
    const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    EXPECT_EQ(tube(points, 0.1, true).mesh.triangles.size(),
              tube(points, 0.1, false).mesh.triangles.size() / 3 * 4);
    EXPECT_TRUE(tube({{0, 0, 0}}, 0.1, true).mesh.triangles.empty());
}

TEST(DrawnPath, IsATubeAlongThePathAndClosedWhereItIs) {
    const Drawing circle = drawn_path(CircleWave{}, 0.01);
    ASSERT_FALSE(circle.mesh.triangles.empty());
    KeyframePath line;
    line.keyframes = {{0, Vec3(0.0)}, {1'000'000'000, Vec3(1, 0, 0)}};
    const Drawing straight = drawn_path(line, 0.01);
    double reach = 0.0;
    for (const Vec3& vertex : straight.mesh.vertices) {
        reach = std::max(reach, vertex.x);
        EXPECT_LE(std::abs(vertex.y), 0.011);
    }
    EXPECT_NEAR(reach, 1.0, 0.011);
}

TEST(DrawnPath, IsNothingWhereThePathCannotBeFollowed) {
    EXPECT_TRUE(drawn_path(KeyframePath{}, 0.01).mesh.triangles.empty());
}

}  // namespace
}  // namespace tactus
