#include "core/tree/triangle_pack.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "shared/random_values.hpp"
#include "shared/slow_distance.hpp"

namespace tactus::triangle_pack_test {
namespace {

using shared::Corners;
using shared::RandomValues;

// Where the way ends; above the limit where nothing stops it.
double first_touch(const TrianglePack& pack, const Vec3& start, const Vec3& motion, double radius,
                   double slack, double limit) {
    const PackHit hit = sweep_to_triangles(pack, {start, motion, radius, slack}, limit);
    return hit.found() ? hit.t : 2.0 * limit + 1.0;
}

constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

void put(TrianglePack& pack, int i, const Corners& t) {
    LanesVec3* const corners[3] = {&pack.a, &pack.b, &pack.c};
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k]->x[i] = t[k].x;
        corners[k]->y[i] = t[k].y;
        corners[k]->z[i] = t[k].z;
    }
}

TrianglePack pack_of(const Corners& triangle) {
    TrianglePack pack;
    for (int i = 0; i < lane_count; ++i) {
        put(pack, i, triangle);
    }
    return pack;
}

double distance(const Corners& triangle, const Vec3& point) {
    return std::sqrt(offset_from_triangles(pack_of(triangle), splat(point)).squared[0]);
}

double largest_coordinate(const Corners& t, const Vec3& p) {
    double largest = 0.0;
    for (int k = 0; k < 3; ++k) {
        largest =
            std::max({largest, std::abs(t[0][k]), std::abs(t[1][k]), std::abs(t[2][k]), std::abs(p[k])});
    }
    return largest;
}

// A triangle of any kind: fat, thin, needle, cap, or without area.
Corners any_triangle(RandomValues& random) {
    const double size = random.magnitude(1e-3, 1e3);
    const Vec3 a = random.in_ball(size);
    const Vec3 b = random.in_ball(size);
    switch (random.below(5)) {
        case 0:
            return {a, b, random.in_ball(size)};
        case 1:  // a needle
            return {a, b, b + random.in_ball(size * random.magnitude(1e-16, 1e-2))};
        case 2:  // a cap: the third corner next to the opposite edge
            return {a, b, a + (b - a) * random.unit() + random.in_ball(size * random.magnitude(1e-18, 1e-2))};
        case 3:  // on a line
            return {a, b, a + (b - a) * random.between(-0.5, 1.5)};
        default:
            return random.flip() ? Corners{a, a, b} : Corners{a, a, a};
    }
}

TEST(TrianglePack, DistanceAgreesWithSlowReferenceOnEveryKindOfTriangle) {
    RandomValues random(11);
    for (int i = 0; i < 40'000; ++i) {
        const Corners t = any_triangle(random);
        const double size = largest_coordinate(t, Vec3(0.0));
        const Vec3 p = random.flip() ? random.in_ball(2.0 * size) : t[0] + random.in_ball(0.1 * size);
        const auto expected = static_cast<double>(shared::slow_distance(p, t));
        ASSERT_NEAR(distance(t, p), expected, 1e-14 * largest_coordinate(t, p)) << "case " << i;
    }
}

TEST(TrianglePack, EveryOrderOfCornersGivesTheSameDistance) {
    RandomValues random(12);
    for (int i = 0; i < 5'000; ++i) {
        const Corners t = any_triangle(random);
        const Vec3 p = random.in_ball(largest_coordinate(t, Vec3(0.0)) * 2.0);
        const double first = distance(t, p);
        for (const auto& order : orders) {
            const Corners turned{t[static_cast<std::size_t>(order[0])], t[static_cast<std::size_t>(order[1])],
                                 t[static_cast<std::size_t>(order[2])]};
            ASSERT_NEAR(distance(turned, p), first, 1e-14 * largest_coordinate(t, p)) << "case " << i;
        }
    }
}

TEST(TrianglePack, EachLaneAnswersForItsOwnTriangle) {
    RandomValues random(13);
    for (int i = 0; i < 1'000; ++i) {
        TrianglePack pack;
        std::array<Corners, lane_count> triangles;
        for (int k = 0; k < lane_count; ++k) {
            triangles[static_cast<std::size_t>(k)] = {random.in_ball(1.0), random.in_ball(1.0),
                                                      random.in_ball(1.0)};
            put(pack, k, triangles[static_cast<std::size_t>(k)]);
        }
        const Vec3 p = random.in_ball(2.0);
        const PackOffset at = offset_from_triangles(pack, splat(p));
        for (int k = 0; k < lane_count; ++k) {
            ASSERT_NEAR(std::sqrt(at.squared[k]),
                        static_cast<double>(shared::slow_distance(p, triangles[static_cast<std::size_t>(k)])),
                        1e-14);
        }
    }
}

TEST(TrianglePack, OffsetPointsFromTheTriangleToThePoint) {
    RandomValues random(14);
    for (int i = 0; i < 5'000; ++i) {
        const Corners t{random.in_ball(1.0), random.in_ball(1.0), random.in_ball(1.0)};
        const Vec3 p = random.in_ball(2.0);
        const PackOffset at = offset_from_triangles(pack_of(t), splat(p));
        const Vec3 foot = p - lane(at.offset, 0);
        ASSERT_LT(static_cast<double>(shared::slow_distance(foot, t)),
                  1e-13 / std::min(1.0, glm::length(glm::cross(t[1] - t[0], t[2] - t[0]))));
    }
}

TEST(TrianglePack, DistanceFarFromTheOriginIsAsGoodAsTheCoordinates) {
    RandomValues random(15);
    for (int i = 0; i < 10'000; ++i) {
        const Vec3 place = 1e4 * random.direction();
        const Corners t{place + random.in_ball(1.0), place + random.in_ball(1.0),
                        place + random.in_ball(1.0)};
        const Vec3 p = place + random.in_ball(2.0);
        ASSERT_NEAR(distance(t, p), static_cast<double>(shared::slow_distance(p, t)), 1e-15 * 1e4);
    }
}

TEST(TrianglePackSweep, NeverPassesTheFirstTouchAndStopsClose) {
    RandomValues random(21);
    int hits = 0;
    for (int i = 0; i < 3'000; ++i) {
        const Corners t = any_triangle(random);
        const double size = largest_coordinate(t, Vec3(0.0));
        const double radius = size * random.magnitude(1e-4, 1.0);
        const Vec3 start = random.in_ball(3.0 * size);
        if (shared::slow_distance(start, t) <= radius * (1.0 + 1e-9)) {
            continue;
        }
        const Vec3 aim = t[0] + (t[1] - t[0]) * random.unit() + random.in_ball(radius);
        const Vec3 motion = (aim - start) * random.between(0.5, 2.0);
        const double slack = 1e-9 * size;
        const double found = first_touch(pack_of(t), start, motion, radius, slack, 1.0);
        const long double expected = shared::slow_sweep(start, motion, radius, t);
        if (expected > 1.0L) {
            // A graze within the slack may count as a hit.
            if (found <= 1.0) {
                ASSERT_LT(static_cast<double>(shared::slow_distance(start + motion * found, t)),
                          radius + 2.0 * slack);
            }
            continue;
        }
        ++hits;
        ASSERT_LE(found, static_cast<double>(expected) + 1e-13) << "case " << i;
        const auto gap = static_cast<double>(shared::slow_distance(start + motion * found, t)) - radius;
        ASSERT_GE(gap, -1e-13 * size) << "case " << i;
        ASSERT_LE(gap, 2.0 * slack) << "case " << i;
    }
    EXPECT_GT(hits, 1'000);
}

TEST(TrianglePackSweep, GrazingWaysEndEarlyNotLate) {
    RandomValues random(22);
    const Corners t{Vec3(0.0, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)};
    const double radius = 0.1;
    for (int i = 0; i < 2'000; ++i) {
        // Above the face by a hair less than the radius at the middle of the way.
        const double depth = random.magnitude(1e-15, 1e-6);
        const double dip = random.magnitude(1e-12, 1e-2);
        const Vec3 start(-0.5, radius - depth + dip, 0.3);
        const Vec3 motion(2.0, -dip * random.between(1.0, 4.0), 0.0);
        const double found = first_touch(pack_of(t), start, motion, radius, 1e-12, 1.0);
        if (found <= 1.0) {
            ASSERT_GE(static_cast<double>(shared::slow_distance(start + motion * found, t)), radius - 1e-15);
        } else {
            ASSERT_GE(static_cast<double>(shared::slow_distance(start + motion * 0.5, t)), radius - 1e-12);
        }
    }
}

// The least distance on the way: it is convex.
double least_distance(const Corners& t, const Vec3& start, const Vec3& motion) {
    long double low = 0.0L, high = 1.0L;
    const auto at = [&](long double share) {
        return shared::slow_closest(shared::SlowVec3(start) + shared::SlowVec3(motion) * share, t).distance;
    };
    for (int i = 0; i < 200; ++i) {
        const long double third = (high - low) / 3.0L;
        (at(low + third) < at(high - third) ? high : low) +=
            (at(low + third) < at(high - third) ? -third : third);
    }
    return static_cast<double>(at(low));
}

// A sphere that goes by an edge, a corner or a face by a hair: by tangents alone it takes a look for every
// halving of the way, and on a floor of small triangles these were most of all looks.
TEST(TrianglePackSweep, WhatIsPassedByAHairIsToldFromBothEnds) {
    RandomValues random(24);
    int passed = 0, looks = 0;
    for (int i = 0; i < 4'000; ++i) {
        const Corners t = any_triangle(random);
        const double size = largest_coordinate(t, Vec3(0.0));
        const Vec3 start = random.in_ball(2.0 * size);
        const Vec3 motion = random.in_ball(2.0 * size);
        const double least = least_distance(t, start, motion);
        if (least < 1e-2 * size) {
            continue;
        }
        const double hair = random.magnitude(1e-10, 1e-2);
        const double slack = 1e-12 * size;
        const PackHit none =
            sweep_to_triangles(pack_of(t), {start, motion, least * (1.0 - hair), slack}, 1.0);
        ASSERT_FALSE(none.found()) << "case " << i;
        const double within = least * (1.0 + hair);
        const PackHit some = sweep_to_triangles(pack_of(t), {start, motion, within, slack}, 1.0);
        const bool touches_from_afar = static_cast<double>(shared::slow_distance(start, t)) > within;
        const bool goes_on = static_cast<double>(shared::slow_distance(start + motion, t)) > within;
        ASSERT_TRUE(some.found() || !(touches_from_afar && goes_on)) << "case " << i;
        ++passed;
        looks += none.looks;
    }
    ASSERT_GT(passed, 2'000);
    EXPECT_LE(2 * looks, 5 * passed);
}

TEST(TrianglePackSweep, WhatSlidesOverAFloorLooksAtItsTrianglesTwiceAtMost) {
    RandomValues random(25);
    for (int i = 0; i < 1'000; ++i) {
        const Corners t{random.in_box(0.01), random.in_box(0.01), random.in_box(0.01)};
        Corners flat = t;
        for (Vec3& corner : flat) {
            corner.y = 0.0;
        }
        const Vec3 start = Vec3(random.between(-0.1, 0.1), 0.1 + 1e-9, random.between(-0.1, 0.1));
        const Vec3 motion(random.between(-0.2, 0.2), 0.0, random.between(-0.2, 0.2));
        const PackHit hit = sweep_to_triangles(pack_of(flat), {start, motion, 0.1, 1e-10}, 1.0);
        ASSERT_FALSE(hit.found());
        ASSERT_LE(hit.looks, 2);
    }
}

TEST(TrianglePackSweep, WhatIsKnownOfTheEndSavesALook) {
    RandomValues random(26);
    int saved = 0;
    for (int i = 0; i < 2'000; ++i) {
        const Corners t = any_triangle(random);
        const double size = largest_coordinate(t, Vec3(0.0));
        const SphereWay way{random.in_ball(2.0 * size), random.in_ball(2.0 * size),
                            size * random.magnitude(1e-3, 1.0), 1e-9 * size};
        const LanesVec3 to = splat(way.start + way.motion);
        const PackBound end = bound_from(offset_from_triangles(pack_of(t), to), to);
        const PackHit alone = sweep_to_triangles(pack_of(t), way, 1.0);
        const PackHit told = sweep_to_triangles(pack_of(t), way, 1.0, &end);
        ASSERT_EQ(alone.found(), told.found()) << "case " << i;
        ASSERT_EQ(alone.t, told.t) << "case " << i;
        saved += alone.looks - told.looks;
        ASSERT_LE(told.looks, alone.looks);
    }
    EXPECT_GT(saved, 200);
}

TEST(TrianglePackSweep, MovingAwayFromWithinIsNoHitMovingCloserIsAtOnce) {
    const Corners t{Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)};
    const Vec3 start(0.2, 0.05, 0.2);
    EXPECT_GT(first_touch(pack_of(t), start, Vec3(0.0, 1.0, 0.0), 0.1, 1e-9, 1.0), 1.0);
    EXPECT_EQ(first_touch(pack_of(t), start, Vec3(0.0, -1.0, 0.0), 0.1, 1e-9, 1.0), 0.0);
}

TEST(TrianglePackSweep, HitsBeyondTheLimitAreNone) {
    const Corners t{Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)};
    const Vec3 start(0.2, 1.0, 0.2);
    EXPECT_NEAR(first_touch(pack_of(t), start, Vec3(0.0, -2.0, 0.0), 0.1, 1e-12, 1.0), 0.45, 1e-12);
    EXPECT_GT(first_touch(pack_of(t), start, Vec3(0.0, -2.0, 0.0), 0.1, 1e-12, 0.4), 0.4);
}

TEST(TrianglePackSweep, OneHundredMetresPerSecondAgainstAPaperThinWallStops) {
    RandomValues random(23);
    for (int i = 0; i < 2'000; ++i) {
        const Corners t{Vec3(-1.0, 0.0, -1.0), Vec3(1.0, 0.0, -1.0), Vec3(0.0, 0.0, 1.5)};
        const double radius = random.magnitude(1e-6, 1e-2);
        const Vec3 start =
            Vec3(random.between(-0.2, 0.2), random.between(0.01, 0.05), random.between(-0.2, 0.2));
        const Vec3 motion(0.0, -0.1, 0.0);  // in one millisecond
        const double found = first_touch(pack_of(t), start, motion, radius, 1e-12, 1.0);
        ASSERT_LE(found, 1.0);
        ASSERT_NEAR(start.y + motion.y * found, radius, 1e-11);
    }
}

// The normal of three corners on a line is nothing but rounding. A point above the line along that very
// normal is "inside" for the areas; it must still not seem farther than it is.
TEST(TrianglePack, APointAboveASliverAlongItsRoundedNormalIsNotTakenFartherThanItIs) {
    RandomValues random(16);
    double worst = 0.0;
    for (int i = 0; i < 200'000; ++i) {
        const Vec3 a = random.in_ball(1.0);
        const Vec3 b = random.in_ball(1.0);
        const Vec3 c = a + (b - a) * random.unit() + random.in_ball(random.magnitude(1e-19, 1e-14));
        const Vec3 normal = glm::cross(b - a, c - a);
        if (glm::length(normal) == 0.0) {
            continue;
        }
        const Corners t{a, b, c};
        const Vec3 p = a + (c - a) * random.unit() + glm::normalize(normal) * random.magnitude(1e-3, 1.0);
        worst = std::max(worst, distance(t, p) - static_cast<double>(shared::slow_distance(p, t)));
    }
    EXPECT_LT(worst, 1e-14);
}

}  // namespace
}  // namespace tactus::triangle_pack_test
