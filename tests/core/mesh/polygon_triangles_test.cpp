#include "core/mesh/polygon_triangles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "shared/random_values.hpp"

namespace tactus::polygon_triangles_test {
namespace {

using shared::RandomValues;
using Polygon = std::vector<Vec3>;

Vec3 area_of(const Polygon& p) {
    Vec3 sum(0.0);
    for (std::size_t i = 0; i < p.size(); ++i) {
        sum += 0.5 * glm::cross(p[i], p[(i + 1) % p.size()]);
    }
    return sum;
}

// The triangles cover as much as the polygon and none lies the other way round: then they are the polygon.
void expect_covered(const Polygon& polygon, double tolerance = 1e-12) {
    std::vector<std::uint32_t> corners(polygon.size());
    std::iota(corners.begin(), corners.end(), 0u);
    std::int64_t work = 1'000'000'000;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    ASSERT_TRUE(add_polygon(polygon, corners, work, triangles));
    const Vec3 normal = glm::normalize(area_of(polygon));
    double covered = 0.0;
    for (const auto& [a, b, c] : triangles) {
        const double area =
            0.5 * glm::dot(normal, glm::cross(polygon[b] - polygon[a], polygon[c] - polygon[a]));
        ASSERT_GE(area, -tolerance);
        covered += area;
    }
    EXPECT_NEAR(covered, glm::length(area_of(polygon)), tolerance * static_cast<double>(polygon.size()));
    EXPECT_LE(triangles.size(), polygon.size() - 2);
}

// A comb in the x-y plane: `teeth` thin teeth on a thin back.
Polygon comb(int teeth) {
    Polygon polygon{{0.0, 0.0, 0.0}, {2.0 * teeth, 0.0, 0.0}};
    for (int i = teeth; i-- > 0;) {
        polygon.insert(polygon.end(), {{2.0 * i + 1.0, 0.1, 0.0}, {2.0 * i + 0.5, 5.0, 0.0}});
    }
    polygon.push_back({0.0, 0.1, 0.0});
    return polygon;
}

// A star about the origin with random spikes: concave, simple.
Polygon star(RandomValues& random, int corners) {
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i + 0.4 * random.unit()) / corners;
        polygon.push_back(random.magnitude(0.02, 1.0) * Vec3(std::cos(angle), std::sin(angle), 0.0));
    }
    return polygon;
}

TEST(PolygonTriangles, ConcaveOnesAreCutInsideTheirRim) {
    expect_covered({{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {2.0, 2.0, 0.0}, {1.9, 0.1, 0.0}});
    expect_covered(comb(5));
    expect_covered(comb(32));
    RandomValues random(7);
    for (int i = 0; i < 300; ++i) {
        expect_covered(star(random, 3 + random.below(120)));
    }
}

TEST(PolygonTriangles, FromEverySideAndWithEveryFirstCorner) {
    RandomValues random(8);
    for (int i = 0; i < 100; ++i) {
        const Quat turn = random.rotation();
        Polygon polygon = star(random, 17);
        for (Vec3& p : polygon) {
            p = turn * p + Vec3(3.0, -2.0, 1.0);
        }
        for (std::size_t first = 0; first < polygon.size(); ++first) {
            std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
            expect_covered(polygon);
        }
        std::reverse(polygon.begin(), polygon.end());
        expect_covered(polygon);
    }
}

TEST(PolygonTriangles, CornersOnALineAndTwiceTakeNothingAway) {
    Polygon square;
    for (int i = 0; i < 40; ++i) {
        const double along = (i % 10) / 10.0;
        const Vec3 sides[] = {
            {along, 0.0, 0.0}, {1.0, along, 0.0}, {1.0 - along, 1.0, 0.0}, {0.0, 1.0 - along, 0.0}};
        square.push_back(sides[i / 10]);
        if (i % 7 == 0) {
            square.push_back(square.back());
        }
    }
    for (std::size_t first = 0; first < square.size(); ++first) {
        std::rotate(square.begin(), square.begin() + 1, square.end());
        expect_covered(square);
    }
    // A square with a square hole, joined by a slit that is walked twice.
    expect_covered({{0, 0, 0},
                    {3, 0, 0},
                    {3, 3, 0},
                    {0, 3, 0},
                    {0, 0, 0},
                    {1, 1, 0},
                    {1, 2, 0},
                    {2, 2, 0},
                    {2, 1, 0},
                    {1, 1, 0}});
}

TEST(PolygonTriangles, NearlyFlatOnesAreCutAsSeenAlongTheirNormal) {
    RandomValues random(9);
    for (int i = 0; i < 50; ++i) {
        Polygon polygon = comb(6);
        for (Vec3& p : polygon) {
            p.z = 1e-3 * random.unit();
        }
        expect_covered(polygon, 2e-2);
    }
}

TEST(PolygonTriangles, WhatHasNoAreaOrCrossesItselfEnds) {
    const Polygon cases[] = {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                             {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
                             {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
                             {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {1, -1, 0}, {3, 3, 0}, {-1, 1, 0}}};
    for (const Polygon& polygon : cases) {
        std::vector<std::uint32_t> corners(polygon.size());
        std::iota(corners.begin(), corners.end(), 0u);
        std::int64_t work = 10'000;
        std::vector<std::array<std::uint32_t, 3>> triangles;
        EXPECT_TRUE(add_polygon(polygon, corners, work, triangles));
        EXPECT_LE(triangles.size(), polygon.size() - 2);
    }
}

}  // namespace
}  // namespace tactus::polygon_triangles_test
