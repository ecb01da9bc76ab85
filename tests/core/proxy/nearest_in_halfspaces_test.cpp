#include "core/proxy/nearest_in_halfspaces.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "shared/random_values.hpp"

namespace tactus::nearest_in_halfspaces_test {
namespace {

using shared::RandomValues;

NearestInHalfSpaces solve(const Vec3& goal, std::span<const HalfSpace> halfspaces, double tolerance) {
    WorkBudget work(1'000'000);
    return nearest_in_halfspaces(goal, halfspaces, tolerance, work);
}

bool allowed(const Vec3& p, const std::vector<HalfSpace>& all, double tolerance) {
    for (const HalfSpace& h : all) {
        if (glm::dot(h.normal, p) < h.offset - tolerance) {
            return false;
        }
    }
    return true;
}

// Every set of up to three borders: the nearest point on all of them, kept where it is allowed. The nearest
// of those is the answer.
struct Enumerated {
    Vec3 point{0.0};
    bool feasible = false;
};

Enumerated enumerate(const Vec3& goal, const std::vector<HalfSpace>& all, double tolerance) {
    Enumerated best;
    double nearest = 1e300;
    const auto consider = [&](const Vec3& p) {
        if (std::isfinite(p.x + p.y + p.z) && glm::length(p - goal) < nearest && allowed(p, all, tolerance)) {
            best = {p, true};
            nearest = glm::length(p - goal);
        }
    };
    consider(goal);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const HalfSpace& a = all[i];
        consider(goal + a.normal * (a.offset - glm::dot(a.normal, goal)));
        for (std::size_t j = i + 1; j < all.size(); ++j) {
            const HalfSpace& b = all[j];
            const Vec3 line = glm::cross(a.normal, b.normal);
            if (glm::length(line) < 1e-9) {
                continue;
            }
            const auto meet = [&](const Vec3& third, double offset) {
                const Mat3 rows = glm::transpose(Mat3(a.normal, b.normal, third));
                return glm::inverse(rows) * Vec3(a.offset, b.offset, offset);
            };
            const Vec3 along = glm::normalize(line);
            consider(meet(along, glm::dot(along, goal)));
            for (std::size_t k = j + 1; k < all.size(); ++k) {
                if (std::abs(glm::dot(along, all[k].normal)) > 1e-9) {
                    consider(meet(all[k].normal, all[k].offset));
                }
            }
        }
    }
    return best;
}

// Half-spaces that all hold the origin: as contact planes hold the proxy.
std::vector<HalfSpace> around_origin(RandomValues& random, int count, double deepest) {
    std::vector<HalfSpace> all;
    for (int i = 0; i < count; ++i) {
        all.push_back({random.direction(), -deepest * random.unit()});
    }
    return all;
}

TEST(NearestInHalfSpaces, AgreesWithEnumeration) {
    RandomValues random(61);
    for (int i = 0; i < 20'000; ++i) {
        const std::vector<HalfSpace> all = around_origin(random, 1 + random.below(9), 1.0);
        const Vec3 goal = random.in_ball(2.0);
        const NearestInHalfSpaces found = solve(goal, all, 1e-12);
        const Enumerated expected = enumerate(goal, all, 1e-9);
        ASSERT_TRUE(found.feasible);
        ASSERT_TRUE(expected.feasible);
        ASSERT_TRUE(allowed(found.point, all, 1e-9)) << "case " << i;
        ASSERT_NEAR(glm::length(found.point - goal), glm::length(expected.point - goal), 1e-8)
            << "case " << i;
    }
}

TEST(NearestInHalfSpaces, TheOrderDoesNotMatter) {
    RandomValues random(62);
    for (int i = 0; i < 2'000; ++i) {
        std::vector<HalfSpace> all = around_origin(random, 6, 0.5);
        const Vec3 goal = random.in_ball(2.0);
        const Vec3 first = solve(goal, all, 1e-12).point;
        for (int turn = 0; turn < 6; ++turn) {
            std::swap(all[static_cast<std::size_t>(random.below(6))],
                      all[static_cast<std::size_t>(random.below(6))]);
            ASSERT_LT(glm::length(solve(goal, all, 1e-12).point - first), 1e-7);
        }
    }
}

TEST(NearestInHalfSpaces, MultipliersAreWhatTheBordersHoldBack) {
    RandomValues random(63);
    for (int i = 0; i < 10'000; ++i) {
        const std::vector<HalfSpace> all = around_origin(random, 5, 1.0);
        const Vec3 goal = random.in_ball(3.0);
        const NearestInHalfSpaces found = solve(goal, all, 1e-12);
        Vec3 held(0.0);
        for (int k = 0; k < found.active_count; ++k) {
            ASSERT_GE(found.multiplier[k], 0.0);
            held += found.multiplier[k] * all[static_cast<std::size_t>(found.active[k])].normal;
        }
        ASSERT_LT(glm::length(found.point - goal - held), 1e-6 * (1.0 + glm::length(held))) << "case " << i;
    }
}

TEST(NearestInHalfSpaces, AllowedGoalIsItsOwnAnswer) {
    const std::vector<HalfSpace> all{{Vec3(0.0, 1.0, 0.0), 0.0}, {Vec3(1.0, 0.0, 0.0), -1.0}};
    const NearestInHalfSpaces found = solve({0.0, 0.5, 0.0}, all, 1e-12);
    EXPECT_EQ(found.point, Vec3(0.0, 0.5, 0.0));
    EXPECT_EQ(found.active_count, 0);
}

TEST(NearestInHalfSpaces, ThreePlanesMeetInACorner) {
    const std::vector<HalfSpace> all{{Vec3(1, 0, 0), 0.0}, {Vec3(0, 1, 0), 0.0}, {Vec3(0, 0, 1), 0.0}};
    const NearestInHalfSpaces found = solve({-1.0, -2.0, -3.0}, all, 1e-12);
    EXPECT_LT(glm::length(found.point), 1e-15);
    EXPECT_EQ(found.active_count, 3);
    EXPECT_NEAR(found.multiplier[0] + found.multiplier[1] + found.multiplier[2], 6.0, 1e-14);
}

TEST(NearestInHalfSpaces, NearlyParallelPlanesStaySmall) {
    RandomValues random(64);
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 normal = random.direction();
        std::vector<HalfSpace> all;
        for (int k = 0; k < 4; ++k) {
            all.push_back({glm::normalize(normal + random.in_ball(random.magnitude(1e-17, 1e-3))),
                           -random.magnitude(1e-12, 1e-3)});
        }
        const Vec3 goal = random.in_ball(0.1) - 0.1 * normal;
        const NearestInHalfSpaces found = solve(goal, all, 1e-12);
        ASSERT_TRUE(found.feasible) << "case " << i;
        ASSERT_TRUE(allowed(found.point, all, 1e-9)) << "case " << i;
        // The origin is allowed, so the answer cannot be farther from the goal than that.
        ASSERT_LE(glm::length(found.point - goal), glm::length(goal) * (1.0 + 1e-9) + 1e-9) << "case " << i;
    }
}

TEST(NearestInHalfSpaces, NarrowWedgesKeepTheirGroove) {
    for (const double degrees : {0.5, 1.0, 5.0, 30.0, 90.0, 150.0, 179.0, 179.5}) {
        const double half = degrees * 0.5 * 3.14159265358979 / 180.0;
        const std::vector<HalfSpace> all{{Vec3(std::cos(half), std::sin(half), 0.0), 0.0},
                                         {Vec3(-std::cos(half), std::sin(half), 0.0), 0.0}};
        const NearestInHalfSpaces found = solve({0.0, -1.0, 0.3}, all, 1e-14);
        EXPECT_LT(glm::length(found.point - Vec3(0.0, 0.0, 0.3)), 1e-10) << degrees;
        EXPECT_NEAR(found.multiplier[0] * std::sin(half) + found.multiplier[1] * std::sin(half), 1.0, 1e-9)
            << degrees;
    }
}

TEST(NearestInHalfSpaces, OppositePlanesThatLeaveNothingAreInfeasible) {
    const std::vector<HalfSpace> all{{Vec3(0, 1, 0), 1.0}, {Vec3(0, -1, 0), 1.0}};
    EXPECT_FALSE(solve(Vec3(0.0), all, 1e-12).feasible);
    const std::vector<HalfSpace> three{
        {Vec3(0, 1, 0), 1.0}, {glm::normalize(Vec3(1, -1, 0)), 1.0}, {glm::normalize(Vec3(-1, -1, 0)), 1.0}};
    EXPECT_FALSE(solve(Vec3(0.0), three, 1e-12).feasible);
}

TEST(NearestInHalfSpaces, OppositePlanesThatTouchLeaveTheirPlane) {
    const std::vector<HalfSpace> all{{Vec3(0, 1, 0), 0.0}, {Vec3(0, -1, 0), 0.0}};
    const NearestInHalfSpaces found = solve({1.0, -2.0, 3.0}, all, 1e-12);
    ASSERT_TRUE(found.feasible);
    EXPECT_LT(glm::length(found.point - Vec3(1.0, 0.0, 3.0)), 1e-12);
}

TEST(NearestInHalfSpaces, AgreesWithEnumerationWhereAllBordersMeet) {
    RandomValues random(61);
    for (int i = 0; i < 20'000; ++i) {
        const std::vector<HalfSpace> all = around_origin(random, 1 + random.below(9), 0.0);
        const Vec3 goal = random.in_ball(2.0);
        const NearestInHalfSpaces found = solve(goal, all, 1e-12);
        const Enumerated expected = enumerate(goal, all, 1e-9);
        ASSERT_TRUE(found.feasible);
        ASSERT_TRUE(expected.feasible);
        ASSERT_TRUE(allowed(found.point, all, 1e-9)) << "case " << i;
        ASSERT_NEAR(glm::length(found.point - goal), glm::length(expected.point - goal), 1e-8)
            << "case " << i;
    }
}

}  // namespace
}  // namespace tactus::nearest_in_halfspaces_test
