#include "sensing/discovery/pose_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/math/body_motion.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus::pose_fit_test {
namespace {

const Vec3 half(0.05, 0.03, 0.04);

const MeshField& box_field() {
    static const MeshField field = MeshField::build(shared::box(half), 0.003, 0.03);
    return field;
}

const Pose truth{{0.02, -0.03, -0.8}, turn_by({0.5, 0.7, 0.2}, 1.0)};

// Points of those faces of the box that the camera sees.
PointSet seen_points(int count, double noise, std::uint64_t seed = 1) {
    shared::RandomValues random(seed);
    PointSet points;
    const Vec3 eye = to_local(truth, Vec3(0.0));
    while (static_cast<int>(points.size()) < count) {
        Vec3 p = random.in_box(1.0) * half;
        const int axis = random.below(3);
        p[axis] = random.flip() ? half[axis] : -half[axis];
        Vec3 normal(0.0);
        normal[axis] = p[axis] > 0.0 ? 1.0 : -1.0;
        if (glm::dot(normal, eye - p) > 0.0) {
            const Vec3 seen = to_parent(truth, p);
            points.add(seen * (1.0 + noise * random.between(-1.7, 1.7) / 0.8), 1.6e-3);
        }
    }
    points.close();
    return points;
}

TEST(PoseFit, ComesBackFromTwentyMillimetersAndFifteenDegrees) {
    const PointSet points = seen_points(600, 0.0);
    shared::RandomValues random(2);
    int back = 0;
    for (int i = 0; i < 50; ++i) {
        const Pose start{truth.position + 0.02 * random.direction(),
                         glm::normalize(turn_by(0.26 * random.direction(), 1.0) * truth.rotation)};
        const PoseFit fit = fit_pose(box_field(), points, start, 0.03, 0.005, 12);
        back += fit.sound && glm::length(fit.pose.position - truth.position) < 5e-4 &&
                angle_between(fit.pose.rotation, truth.rotation) < 5e-3;
    }
    EXPECT_GE(back, 47);
}

TEST(PoseFit, ChanceIsAveragedOut) {
    const PoseFit fit = fit_pose(box_field(), seen_points(900, 1e-3), truth, 0.01, 0.006, 6);
    ASSERT_TRUE(fit.sound);
    EXPECT_LT(glm::length(fit.pose.position - truth.position), 5e-4);
    EXPECT_LT(angle_between(fit.pose.rotation, truth.rotation), 6e-3);
}

TEST(PoseFit, TooFewPointsMoveNothing) {
    const Pose start{truth.position + Vec3(0.005, 0.0, 0.0), truth.rotation};
    for (const int count : {0, 5}) {
        const PoseFit fit = fit_pose(box_field(), seen_points(count, 0.0), start, 0.02, 0.005, 5);
        EXPECT_FALSE(fit.sound);
        EXPECT_EQ(fit.pose.position, start.position);
    }
}

TEST(PoseFit, PointsThatAreNoneDoNotCount) {
    PointSet points = seen_points(300, 0.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < 20; ++i) {
        points.add({nan, 0.0, -0.8}, 1e-3);
        points.add({5.0, 5.0, -9.0}, 1e-3);
    }
    points.close();
    const Pose start{truth.position + Vec3(0.004, 0.0, 0.0), truth.rotation};
    const PoseFit fit = fit_pose(box_field(), points, start, 0.02, 0.005, 8);
    ASSERT_TRUE(fit.sound);
    EXPECT_LT(glm::length(fit.pose.position - truth.position), 5e-4);
}

// The step from a small offset is that offset: the rows of the normal equations are right.
TEST(PoseFit, TheNormalEquationsAreThoseOfASmallMotion) {
    const PointSet points = seen_points(600, 0.0);
    const Vec3 v(3e-4, -2e-4, 1e-4), w(2e-3, 1e-3, -3e-3);
    PoseFit fit{moved_in_own_frame(truth, v, w), {}, true};
    fit.sums = fit_sums(box_field(), points, fit.pose, 0.02);
    ASSERT_TRUE(step_pose(fit, {1.0, 1.0}));
    EXPECT_LT(glm::length(fit.pose.position - truth.position), 6e-5);
    EXPECT_LT(angle_between(fit.pose.rotation, truth.rotation), 6e-4);
}

TEST(PoseFit, TheCovarianceIsWhatChanceMakes) {
    double squares = 0.0;
    Matrix6 covariance{};
    constexpr int tries = 60;
    for (int i = 0; i < tries; ++i) {
        const PoseFit fit = fit_pose(box_field(), seen_points(600, 1.6e-3, 100u + static_cast<unsigned>(i)),
                                     truth, 0.012, 0.008, 6);
        const Vec3 off = fit.pose.position - truth.position;
        squares += glm::dot(off, off) / tries;
        covariance = fit_covariance(fit, {});
    }
    const double told = covariance[0][0] + covariance[1][1] + covariance[2][2];
    EXPECT_GT(squares, 0.3 * told);
    EXPECT_LT(squares, 3.0 * told);
}

TEST(PoseFit, WhatIsNotSeenIsUnsure) {
    static const MeshField sphere = MeshField::build(shared::icosphere(4, 0.05), 0.003, 0.03);
    PointSet points;
    shared::RandomValues random(9);
    while (points.size() < 400) {
        const Vec3 p = 0.05 * random.direction();
        if (p.z > 0.01) {
            points.add(p + Vec3(0.0, 0.0, -0.8), 1.6e-3);
        }
    }
    points.close();
    const FitPrior prior;
    const PoseFit fit =
        fit_pose(sphere, points, {{0.0, 0.0, -0.8}, {1.0, 0.0, 0.0, 0.0}}, 0.01, 0.006, 4, prior);
    const Matrix6 covariance = fit_covariance(fit, prior);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_LT(std::sqrt(covariance[i][i]), 5e-4);
        EXPECT_GT(std::sqrt(covariance[i + 3][i + 3]), 0.03);
    }
}

TEST(PoseFit, ATurnedCovarianceKeepsItsTrace) {
    Matrix6 covariance{};
    for (std::size_t i = 0; i < 6; ++i) {
        covariance[i][i] = static_cast<double>(i + 1);
    }
    const Matrix6 turned = turned_covariance(covariance, turn_by({0.0, 1.5707963267948966, 0.0}, 1.0));
    EXPECT_NEAR(turned[0][0], 3.0, 1e-12);
    EXPECT_NEAR(turned[1][1], 2.0, 1e-12);
    EXPECT_NEAR(turned[2][2], 1.0, 1e-12);
    EXPECT_NEAR(turned[3][3], 6.0, 1e-12);
}

}  // namespace
}  // namespace tactus::pose_fit_test
