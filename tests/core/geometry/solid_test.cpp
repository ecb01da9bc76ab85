#include "core/geometry/solid.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "shared/random_values.hpp"

namespace tactus::solid_test {
namespace {

using shared::RandomValues;

// Where the way ends; above the limit where nothing stops it.
double first_touch(const Solid& solid, const Vec3& start, const Vec3& motion, double radius, double slack,
                   double limit) {
    WorkBudget work(1'000'000);
    const Hit hit = sweep_to_solid(solid, {start, motion, radius, slack}, limit, work);
    return hit.found ? hit.t : 2.0 * limit + 1.0;
}

const Solid solids[] = {SphereShape{0.7}, BoxShape{Vec3(0.5, 0.8, 0.3)}, CapsuleShape{0.3, 0.6},
                        CylinderShape{0.4, 0.5}, PlaneShape{glm::normalize(Vec3(1.0, 2.0, -0.5)), 0.3}};

double distance(const Solid& solid, const Vec3& p) {
    return distance_to_solid(solid, p).distance;
}

// Distances from first principles, by cases that the code does not have.
long double slow_distance(const SphereShape& s, const Vec3& p) {
    return glm::length(p) - s.radius;
}
long double slow_distance(const BoxShape& b, const Vec3& p) {
    const Vec3 q = glm::abs(p) - b.half_extents;
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}
long double slow_distance(const CapsuleShape& c, const Vec3& p) {
    long double nearest = 1e300L;
    for (int i = 0; i <= 200'000; ++i) {
        const double y = c.half_segment * (i / 100'000.0 - 1.0);
        nearest = std::min(nearest, static_cast<long double>(glm::length(p - Vec3(0.0, y, 0.0))));
    }
    return nearest - c.radius;
}
long double slow_distance(const CylinderShape& c, const Vec3& p) {
    const double side = std::hypot(p.x, p.z) - c.radius;
    const double cap = std::abs(p.y) - c.half_height;
    return std::min(std::max(side, cap), 0.0) + std::hypot(std::max(side, 0.0), std::max(cap, 0.0));
}
long double slow_distance(const PlaneShape& s, const Vec3& p) {
    return glm::dot(s.normal, p) - s.offset;
}

TEST(Solid, DistanceIsThatOfTheDefinition) {
    RandomValues random(51);
    for (const Solid& solid : solids) {
        const bool scanned = std::holds_alternative<CapsuleShape>(solid);
        for (int i = 0; i < (scanned ? 40 : 5'000); ++i) {
            const Vec3 p = random.in_ball(2.0);
            const auto expected =
                static_cast<double>(std::visit([&](const auto& s) { return slow_distance(s, p); }, solid));
            ASSERT_NEAR(distance(solid, p), expected, scanned ? 1e-9 : 1e-14) << "shape " << solid.index();
        }
    }
}

TEST(Solid, NormalIsTheGradientOfTheDistance) {
    RandomValues random(52);
    constexpr double h = 1e-6;
    for (const Solid& solid : solids) {
        for (int i = 0; i < 2'000; ++i) {
            const Vec3 p = random.in_ball(2.0);
            const SolidDistance at = distance_to_solid(solid, p);
            if (at.distance < 0.01) {
                continue;
            }
            ASSERT_NEAR(glm::length(at.normal), 1.0, 1e-14);
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 step(0.0);
                step[axis] = h;
                const double slope = (distance(solid, p + step) - distance(solid, p - step)) / (2.0 * h);
                ASSERT_NEAR(at.normal[axis], slope, 1e-4) << "shape " << solid.index();
            }
        }
    }
}

TEST(Solid, BendsAreTheSecondDerivativesOfTheDistance) {
    RandomValues random(53);
    constexpr double h = 1e-4;
    for (const Solid& solid : solids) {
        for (int i = 0; i < 2'000; ++i) {
            const Vec3 p = random.in_ball(2.0);
            const SolidDistance at = distance_to_solid(solid, p);
            if (at.distance < 0.05) {
                continue;
            }
            ASSERT_NEAR(glm::dot(at.u, at.normal), 0.0, 1e-14);
            ASSERT_NEAR(glm::length(at.u), 1.0, 1e-14);
            const Vec3 v = glm::cross(at.normal, at.u);
            const auto bend = [&](const Vec3& along) {
                return (distance(solid, p + h * along) - 2.0 * at.distance + distance(solid, p - h * along)) /
                       (h * h);
            };
            // Next to a seam between two pieces the second derivative jumps: skip where the pieces differ.
            const auto same_piece = [&](const Vec3& along) {
                const SolidDistance a = distance_to_solid(solid, p + 2.0 * h * along);
                const SolidDistance b = distance_to_solid(solid, p - 2.0 * h * along);
                return std::abs(a.bend_u - b.bend_u) + std::abs(a.bend_v - b.bend_v) < 0.2;
            };
            if (!same_piece(at.u) || !same_piece(v)) {
                continue;
            }
            ASSERT_NEAR(at.bend_u, bend(at.u), 1e-2) << "shape " << solid.index() << " at " << i;
            ASSERT_NEAR(at.bend_v, bend(v), 1e-2) << "shape " << solid.index() << " at " << i;
        }
    }
}

TEST(Solid, SweepStopsAtTheFirstTouchNeverPastIt) {
    RandomValues random(54);
    for (const Solid& solid : solids) {
        int hits = 0;
        for (int i = 0; i < 3'000; ++i) {
            const Vec3 start = random.in_ball(3.0);
            const double radius = random.magnitude(1e-3, 0.5);
            if (distance(solid, start) <= radius * 1.01) {
                continue;
            }
            const Vec3 motion = (random.in_ball(1.0) - start) * random.between(0.5, 2.0);
            constexpr double slack = 1e-10;
            const double found = first_touch(solid, start, motion, radius, slack, 1.0);
            double first = 2.0;  // a fine walk, then a bisection
            for (int k = 1; k <= 2'000; ++k) {
                if (distance(solid, start + motion * (k / 2'000.0)) < radius) {
                    double low = (k - 1) / 2'000.0;
                    double high = k / 2'000.0;
                    for (int j = 0; j < 60; ++j) {
                        const double middle = 0.5 * (low + high);
                        (distance(solid, start + motion * middle) < radius ? high : low) = middle;
                    }
                    first = high;
                    break;
                }
            }
            if (first > 1.0) {
                continue;  // the walk may miss a graze; the sweep may not miss what the walk finds
            }
            ++hits;
            ASSERT_LE(found, first + 1e-12) << "shape " << solid.index();
            const double gap = distance(solid, start + motion * found) - radius;
            ASSERT_GE(gap, -1e-13) << "shape " << solid.index();
            ASSERT_LE(gap, 2.0 * slack) << "shape " << solid.index();
        }
        EXPECT_GT(hits, 300) << "shape " << solid.index();
    }
}

TEST(Solid, SweepAwayFromWithinIsNoHit) {
    EXPECT_GT(first_touch(SphereShape{0.7}, Vec3(0.0, 0.75, 0.0), Vec3(0.0, 1.0, 0.0), 0.1, 1e-9, 1.0), 1.0);
    EXPECT_EQ(first_touch(SphereShape{0.7}, Vec3(0.0, 0.75, 0.0), Vec3(0.0, -1.0, 0.0), 0.1, 1e-9, 1.0), 0.0);
}

TEST(Solid, BoundingBallHoldsTheSolid) {
    RandomValues random(55);
    for (const Solid& solid : solids) {
        const double radius = bounding_radius(solid);
        for (int i = 0; i < 2'000; ++i) {
            const Vec3 p = random.in_ball(2.0);
            if (distance(solid, p) <= 0.0) {
                ASSERT_LE(glm::length(p), radius * (1.0 + 1e-15));
            }
        }
    }
}

TEST(Solid, CentresHaveADistanceAndADirection) {
    for (const Solid& solid : solids) {
        const SolidDistance at = distance_to_solid(solid, Vec3(0.0));
        EXPECT_LT(at.distance, 0.0) << "shape " << solid.index();
        EXPECT_NEAR(glm::length(at.normal), 1.0, 1e-14);
        EXPECT_TRUE(std::isfinite(at.bend_u) && std::isfinite(at.bend_v));
    }
}

}  // namespace
}  // namespace tactus::solid_test
