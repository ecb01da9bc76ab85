#include "core/tool/nearest_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <vector>

namespace tactus::nearest_motion_test {
namespace {

constexpr double length = 0.5;

WorkBudget plenty() {
    return WorkBudget(std::numeric_limits<std::int64_t>::max());
}

NearestMotion solved(const Vector6& goal, const std::vector<MotionBound>& bounds, double tolerance = 1e-11) {
    WorkBudget work = plenty();
    return nearest_motion(goal, bounds, length, tolerance, work);
}

// Above zero where the bound forbids the motion.
double violation(const MotionBound& bound, const Vector6& x) {
    const Vec3 way = lowered(x, length).at(bound.arm);
    const double up = glm::dot(bound.normal, way);
    const double slid = glm::length(way - bound.normal * up);
    return -bound.gap - up + bound.friction * (slid - bound.slide);
}

// The conditions of Karush, Kuhn and Tucker, which are sufficient here: allowed; pushed only, within the
// cones, by borders it is on; and the pushes are all there is between goal and answer.
void expect_nearest(const Vector6& goal, const std::vector<MotionBound>& bounds, const NearestMotion& best,
                    double within = 1e-9) {
    ASSERT_TRUE(best.possible);
    ASSERT_EQ(best.missing, 0.0);
    for (const MotionBound& bound : bounds) {
        EXPECT_LE(violation(bound, best.x), within);
    }
    Vector6 sum = goal;
    for (int i = 0; i < best.push_count; ++i) {
        const MotionPush& push = best.pushes[static_cast<std::size_t>(i)];
        const MotionBound& bound = bounds[static_cast<std::size_t>(push.bound)];
        EXPECT_GE(push.size, 0.0);
        EXPECT_NEAR(glm::dot(push.direction, bound.normal), 1.0, 1e-9);
        EXPECT_LE(glm::length(push.direction - bound.normal), bound.friction + 1e-9);
        const Vector6 row = lifted_row(push.direction, bound.arm, length);
        double up = 0.0;
        for (std::size_t j = 0; j < 6; ++j) {
            up += row[j] * best.x[j];
            sum[j] += push.size * row[j];
        }
        EXPECT_NEAR(up, -bound.gap - bound.friction * bound.slide, within);
    }
    for (std::size_t j = 0; j < 6; ++j) {
        // Half-spaces of one cone are nearly parallel: rounding counts more.
        EXPECT_NEAR(sum[j], best.x[j], 1e-9 + 20.0 * (within - 1e-9));
    }
}

class RandomMotions : public testing::Test {
protected:
    double chance() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
    Vector6 goal() {
        Vector6 goal;
        for (double& value : goal) {
            value = chance();
        }
        return goal;
    }
    std::vector<MotionBound> bounds(int count, double friction) {
        std::vector<MotionBound> bounds(static_cast<std::size_t>(count));
        for (MotionBound& bound : bounds) {
            bound.normal = glm::normalize(Vec3(chance(), chance(), chance()));
            bound.arm = {chance(), chance(), chance()};
            bound.gap = 0.1 * std::abs(chance());
            bound.friction = friction * std::abs(chance());
        }
        return bounds;
    }

private:
    std::mt19937 random_{3};
};

TEST_F(RandomMotions, TheNearestIsFound) {
    for (int round = 0; round < 2'000; ++round) {
        const auto among = bounds(round % 60, 0.0);
        const Vector6 wanted = goal();
        expect_nearest(wanted, among, solved(wanted, among));
    }
}

TEST_F(RandomMotions, TheNearestWithinConesIsFound) {
    int unfinished = 0;
    for (int round = 0; round < 1'000; ++round) {
        const auto among = bounds(1 + round % 30, 0.8);
        const Vector6 wanted = goal();
        const NearestMotion best = solved(wanted, among, 1e-6);
        if (best.missing > 0.0) {
            ++unfinished;
        } else {
            expect_nearest(wanted, among, best, 1e-6 + 1e-9);
        }
    }
    EXPECT_LE(unfinished, 10);
}

// A face on a plane has many contacts, of which three hold all.
std::vector<MotionBound> face(double friction) {
    std::vector<MotionBound> bounds;
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 10; ++j) {
            bounds.push_back({{0.0, 1.0, 0.0}, {0.1 * i - 0.5, 0.0, 0.1 * j - 0.5}, 0.0, friction, 0.0});
        }
    }
    return bounds;
}

TEST(NearestMotion, ManyContactsOfOneFaceAreNoTrouble) {
    const Vector6 goal{0.1, -1.0, 0.2, 0.01, 0.3, -0.02};
    const NearestMotion best = solved(goal, face(0.0));
    expect_nearest(goal, face(0.0), best);
    EXPECT_NEAR(best.x[0], 0.1, 1e-12);
    EXPECT_NEAR(best.x[1], 0.0, 1e-9);
    EXPECT_NEAR(best.x[4], 0.3, 1e-12);
}

// Drawn along a face with a force in the cone, and turned on it with a torque that friction bears: pressed
// with 1, its contacts 0.35 from the middle in the mean.
TEST(NearestMotion, AFaceSticksWithinItsCone) {
    const auto length_of = [](const Vector6& goal) {
        const NearestMotion best = solved(goal, face(0.5), 1e-9);
        EXPECT_EQ(best.missing, 0.0);
        double sum = 0.0;
        for (const double value : best.x) {
            sum += value * value;
        }
        return std::sqrt(sum);
    };
    EXPECT_LT(length_of({0.49, -1.0, 0.0, 0.0, 0.0, 0.0}), 1e-7);
    EXPECT_LT(length_of({0.3, -1.0, -0.38, 0.0, 0.0, 0.0}), 1e-7);
    EXPECT_LT(length_of({0.0, -1.0, 0.0, 0.0, 0.1, 0.0}), 1e-7);
    EXPECT_GT(length_of({0.52, -1.0, 0.0, 0.0, 0.0, 0.0}), 1e-3);
}

TEST(NearestMotion, ANarrowWedgeThatLeavesNothingIsSaid) {
    const std::vector<MotionBound> bounds{{{0.0, 1.0, 0.0}, Vec3(0.0), -0.1, 0.0, 0.0},
                                          {{0.0, -1.0, 0.0}, Vec3(0.0), -0.1, 0.0, 0.0}};
    EXPECT_FALSE(solved({}, bounds).possible);
}

TEST(NearestMotion, WithoutWorkWhatIsMissingIsSaid) {
    WorkBudget none(0);
    const std::vector<MotionBound> bounds{{{0.0, 1.0, 0.0}, Vec3(0.0), 0.0, 0.0, 0.0}};
    EXPECT_NEAR(nearest_motion({0.0, -0.2, 0.0, 0.0, 0.0, 0.0}, bounds, length, 1e-9, none).missing, 0.2,
                1e-12);
}

}  // namespace
}  // namespace tactus::nearest_motion_test
