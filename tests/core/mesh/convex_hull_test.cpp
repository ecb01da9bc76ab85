#include "core/mesh/convex_hull.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <random>

#include "shared/mesh_volume.hpp"

namespace tactus::convex_hull_test {
namespace {

using shared::volume;

std::vector<Vec3> cube_corners(double half) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) {
        corners.emplace_back(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half);
    }
    return corners;
}

// Every edge is used once in each direction.
void expect_closed(const TriangleMesh& hull) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : hull.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[{t[k], t[(k + 1) % 3]}];
        }
    }
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
}

void expect_around(const TriangleMesh& hull, const std::vector<Vec3>& points, double slack) {
    for (const auto& [a, b, c] : hull.triangles) {
        const Vec3 origin = hull.vertices[a];
        const Vec3 normal = glm::normalize(glm::cross(hull.vertices[b] - origin, hull.vertices[c] - origin));
        for (const Vec3& point : points) {
            EXPECT_LE(glm::dot(normal, point - origin), slack);
        }
    }
}

TEST(ConvexHull, CubeHasTwelveTrianglesAndItsVolume) {
    const std::vector<Vec3> corners = cube_corners(0.5);
    const TriangleMesh hull = convex_hull(corners);
    EXPECT_EQ(hull.vertices.size(), 8u);
    EXPECT_EQ(hull.triangles.size(), 12u);
    EXPECT_NEAR(volume(hull), 1.0, 1e-12);
    expect_closed(hull);
    expect_around(hull, corners, 1e-8);
}

TEST(ConvexHull, DropsPointsInsideAndCopies) {
    std::vector<Vec3> points = cube_corners(0.5);
    points.emplace_back(0.0);
    points.emplace_back(0.1, 0.2, -0.3);
    points.push_back(points[3]);
    EXPECT_EQ(convex_hull(points).vertices.size(), 8u);
}

TEST(ConvexHull, HoldsRandomPointsOnASphere) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    std::vector<Vec3> points;
    for (int i = 0; i < 500; ++i) {
        points.push_back(0.1 * glm::normalize(Vec3(normal(random), normal(random), normal(random))));
    }
    const TriangleMesh hull = convex_hull(points);
    EXPECT_EQ(hull.vertices.size(), 500u);
    EXPECT_EQ(hull.triangles.size(), 2u * 500u - 4u);  // Euler
    expect_closed(hull);
    expect_around(hull, points, 1e-8);
}

TEST(ConvexHull, HoldsAGridWithManyPointsInOnePlane) {
    std::vector<Vec3> points;
    for (int x = 0; x < 6; ++x) {
        for (int y = 0; y < 6; ++y) {
            for (int z = 0; z < 6; ++z) {
                points.emplace_back(0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y),
                                    0.1f * static_cast<float>(z));
            }
        }
    }
    const TriangleMesh hull = convex_hull(points);
    EXPECT_NEAR(volume(hull), 0.125, 1e-7);
    expect_closed(hull);
    expect_around(hull, points, 1e-7);
}

TEST(ConvexHull, IsEmptyForPointsWithoutVolume) {
    EXPECT_TRUE(convex_hull({}).triangles.empty());
    const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    EXPECT_TRUE(convex_hull(line).triangles.empty());
    const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}};
    EXPECT_TRUE(convex_hull(square).triangles.empty());
    const std::vector<Vec3> same(10, Vec3(1.0));
    EXPECT_TRUE(convex_hull(same).triangles.empty());
}

TEST(ConvexHull, IsEmptyForPointsThatAreNotNumbers) {
    std::vector<Vec3> points = cube_corners(0.5);
    points[2].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(convex_hull(points).triangles.empty());
}

TEST(ConvexHull, GivesTheSameBitsAgain) {
    const std::vector<Vec3> corners = cube_corners(0.3);
    EXPECT_EQ(convex_hull(corners).vertices, convex_hull(corners).vertices);
    EXPECT_EQ(convex_hull(corners).triangles, convex_hull(corners).triangles);
}

}  // namespace
}  // namespace tactus::convex_hull_test
