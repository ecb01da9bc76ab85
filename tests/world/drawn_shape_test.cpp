#include "world/drawn_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <numbers>

#include "shared/mesh_volume.hpp"

namespace tactus::drawn_shape_test {
namespace {

using shared::volume;

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

TEST(DrawnCubeEdges, AreTwelveTubesAlongTheEdges) {
    const TriangleMesh mesh = drawn_cube_edges(2.0, 0.1).mesh;
    EXPECT_EQ(mesh.triangles.size(), 12 * tube({{0, 0, 0}, {1, 0, 0}}, 0.1, false).mesh.triangles.size());
    for (const Vec3& vertex : mesh.vertices) {
        const Vec3 beside = glm::abs(glm::abs(vertex) - Vec3(2.0));
        EXPECT_LE((beside.x < 0.06) + (beside.y < 0.06) + (beside.z < 0.06), 3);
        EXPECT_GE((beside.x < 0.06) + (beside.y < 0.06) + (beside.z < 0.06), 2) << "on no edge";
    }
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

// At a pole two corners of a triangle are one.
bool has_area(const DrawnCorners& corners, std::size_t first) {
    return glm::length(glm::cross(corners.places[first + 1] - corners.places[first],
                                  corners.places[first + 2] - corners.places[first])) > 1e-6f;
}

TEST(DrawnCorners, AreThreeATriangleClockwiseEachWithItsNormal) {
    for (const Drawing& drawing : {drawn_shape(BoxShape{Vec3(1.0)}), drawn_shape(SphereShape{1.0})}) {
        const DrawnCorners corners = corners_of(drawing);
        ASSERT_EQ(corners.places.size(), 3 * drawing.mesh.triangles.size());
        ASSERT_EQ(corners.normals.size(), corners.places.size());
        for (std::size_t i = 0; i < corners.places.size(); i += 3) {
            const glm::vec3 facing = glm::cross(corners.places[i + 2] - corners.places[i],
                                                corners.places[i + 1] - corners.places[i]);
            for (std::size_t corner = i; corner < i + 3 && has_area(corners, i); ++corner) {
                EXPECT_NEAR(glm::length(corners.normals[corner]), 1.0f, 1e-5f);
                EXPECT_GT(glm::dot(corners.normals[corner], facing), 0.0f);
            }
        }
    }
}

TEST(DrawnCorners, AFlatFacetHasItsOwnNormalAndASphereOneForEachPlace) {
    const DrawnCorners box = corners_of(drawn_shape(BoxShape{Vec3(1.0)}));
    EXPECT_EQ(box.normals[0], box.normals[1]);
    const DrawnCorners sphere = corners_of(drawn_shape(SphereShape{1.0}));
    for (std::size_t i = 0; i < sphere.places.size(); i += 3) {
        for (std::size_t corner = i; corner < i + 3 && has_area(sphere, i); ++corner) {
            EXPECT_GT(glm::dot(sphere.places[corner], sphere.normals[corner]), 0.95f);
        }
    }
}

}  // namespace
}  // namespace tactus::drawn_shape_test
