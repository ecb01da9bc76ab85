#include "core/tree/closest_point_on_triangle.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "shared/random_values.hpp"
#include "shared/slow_distance.hpp"

namespace tactus::closest_point_on_triangle_test {
namespace {

using shared::Corners;
using shared::RandomValues;

constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

const Corners triangle{Vec3(0.0, 0.0, 0.0), Vec3(2.0, 0.0, 0.0), Vec3(0.0, 0.0, 3.0)};

void expect_in_every_order(const Vec3& point, const Vec3& closest, TriangleFeature feature) {
    for (const auto& order : orders) {
        const TriangleClosestPoint found = closest_point_on_triangle(
            point, triangle[static_cast<std::size_t>(order[0])], triangle[static_cast<std::size_t>(order[1])],
            triangle[static_cast<std::size_t>(order[2])]);
        EXPECT_LT(glm::length(found.point - closest), 1e-15);
        EXPECT_EQ(found.feature, feature);
    }
}

TEST(ClosestPointOnTriangle, AboveTheFace) {
    expect_in_every_order({0.5, 0.7, 0.5}, {0.5, 0.0, 0.5}, TriangleFeature::face);
}

TEST(ClosestPointOnTriangle, BesideAnEdge) {
    expect_in_every_order({1.0, 0.5, -1.0}, {1.0, 0.0, 0.0}, TriangleFeature::edge);
    expect_in_every_order({-1.0, 0.5, 1.0}, {0.0, 0.0, 1.0}, TriangleFeature::edge);
}

TEST(ClosestPointOnTriangle, BeyondACorner) {
    expect_in_every_order({-1.0, 0.5, -1.0}, triangle[0], TriangleFeature::corner);
    expect_in_every_order({3.0, -0.5, -0.1}, triangle[1], TriangleFeature::corner);
    expect_in_every_order({-0.1, 0.5, 4.0}, triangle[2], TriangleFeature::corner);
}

TEST(ClosestPointOnTriangle, EdgesAreNumberedByTheirFirstCorner) {
    const auto edge_beside = [](const Vec3& point) {
        return closest_point_on_triangle(point, triangle[0], triangle[1], triangle[2]).edge;
    };
    EXPECT_EQ(edge_beside({1.0, 0.5, -1.0}), 0);
    EXPECT_EQ(edge_beside({2.0, 0.5, 2.0}), 1);
    EXPECT_EQ(edge_beside({-1.0, 0.5, 1.0}), 2);
}

TEST(ClosestPointOnTriangle, ATriangleWithoutAreaHasNoFace) {
    const Vec3 a(0.1, 0.2, 0.3);
    const Vec3 b(1.0, 0.0, 2.0);
    EXPECT_EQ(closest_point_on_triangle({0.0, 5.0, 0.0}, a, a, a).feature, TriangleFeature::corner);
    EXPECT_NE(closest_point_on_triangle({0.5, 5.0, 1.0}, a, b, a).feature, TriangleFeature::face);
}

TEST(ClosestPointOnTriangle, AgreesWithSlowReferenceOnThinTriangles) {
    RandomValues random(31);
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 a = random.in_ball(1.0);
        const Vec3 b = random.in_ball(1.0);
        const Vec3 c = a + (b - a) * random.unit() + random.in_ball(random.magnitude(1e-17, 1.0));
        const Vec3 p = random.in_ball(2.0);
        const Vec3 found = closest_point_on_triangle(p, a, b, c).point;
        ASSERT_NEAR(glm::length(p - found), static_cast<double>(shared::slow_distance(p, Corners{a, b, c})),
                    1e-14)
            << "case " << i;
    }
}

TEST(ClosestPointOnTriangle, AboveAFaceIsWhereTheClosestPointIsInside) {
    RandomValues random(37);
    int above = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 a = random.in_ball(1.0);
        const Vec3 b = random.in_ball(1.0);
        const Vec3 c = i % 2 == 0
                           ? random.in_ball(1.0)
                           : a + (b - a) * random.unit() + random.in_ball(random.magnitude(1e-6, 1e-2));
        const Vec3 p = random.in_ball(2.0);
        const bool is_face = closest_point_on_triangle(p, a, b, c).feature == TriangleFeature::face;
        const bool is_above = is_above_face(p, a, b, c);
        ASSERT_TRUE(is_face || !is_above) << "case " << i;
        const Vec3 normal = glm::cross(b - a, c - a);
        const bool is_slim = glm::length(normal) < 0.11 * glm::length(b - a) * glm::length(c - a);
        ASSERT_TRUE(is_above == is_face || is_slim) << "case " << i;
        above += is_above;
    }
    EXPECT_GT(above, 300);
}

TEST(ClosestPointOnTriangle, FarFromTheOriginIsAsGoodAsTheCoordinates) {
    RandomValues random(32);
    for (int i = 0; i < 5'000; ++i) {
        const Vec3 place = 1e4 * random.direction();
        const Corners t{place + random.in_ball(1.0), place + random.in_ball(1.0),
                        place + random.in_ball(1.0)};
        const Vec3 p = place + random.in_ball(2.0);
        const Vec3 found = closest_point_on_triangle(p, t[0], t[1], t[2]).point;
        ASSERT_NEAR(glm::length(p - found), static_cast<double>(shared::slow_distance(p, t)), 2e-11);
    }
}

}  // namespace
}  // namespace tactus::closest_point_on_triangle_test
