#include "core/estimation/motion_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/math/body_motion.hpp"
#include "shared/poses.hpp"
#include "shared/rough_eyes.hpp"

namespace tactus::motion_filter_test {
namespace {

using shared::at;
using shared::RoughEyes;

constexpr Nanoseconds frame = 33'333'333;
constexpr double frame_seconds = 1.0 / 30.0;

Matrix6 covariance_of(double place, double turn) {
    Matrix6 covariance{};
    for (std::size_t i = 0; i < 3; ++i) {
        covariance[i][i] = place * place;
        covariance[i + 3][i + 3] = turn * turn;
    }
    return covariance;
}

Matrix6 covariance_of(const RoughEyes& eyes) {
    return covariance_of(eyes.of_place(), eyes.of_turn());
}

TEST(MotionFilter, TheFirstPoseIsBelieved) {
    MotionFilter filter;
    EXPECT_FALSE(filter.is_known());
    filter.see({}, at({1.0, 2.0, 3.0}), covariance_of(1e-3, 1e-2), frame);
    EXPECT_TRUE(filter.is_known());
    EXPECT_EQ(filter.pose().position, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(filter.linear_velocity(), Vec3(0.0));
}

TEST(MotionFilter, WhatRestsIsToldAtRest) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        MotionFilter filter;
        RoughEyes eyes(1e-3, 5e-3, seed);
        const Pose truth = at({0.1, 0.2, 0.3}, turn_by({0.3, 0.2, 0.1}, 1.0));
        double squares = 0.0;
        int moving = 0, counted = 0;
        for (int i = 1; i <= 1800; ++i) {
            filter.see({}, eyes.see(truth), covariance_of(eyes), i * frame);
            if (i > 600) {
                const Vec3 off = filter.pose().position - truth.position;
                squares += glm::dot(off, off);
                moving += !filter.rests();
                ++counted;
            }
        }
        EXPECT_LT(moving, counted / 50) << seed;
        EXPECT_LT(std::sqrt(squares / counted), 1.5e-4) << seed;
    }
}

TEST(MotionFilter, AtRestVelocitiesAreZeroAndPlacesCreep) {
    MotionFilter filter;
    RoughEyes eyes(1e-3, 5e-3);
    const MotionFilterSettings settings;
    Pose before;
    bool rested = false;
    for (int i = 1; i <= 600; ++i) {
        filter.see(settings, eyes.see(at({0.0, 0.0, 0.0})), covariance_of(eyes), i * frame);
        if (filter.rests()) {
            EXPECT_EQ(filter.linear_velocity(), Vec3(0.0));
            EXPECT_EQ(filter.angular_velocity(), Vec3(0.0));
            if (rested) {
                const double fastest = i > settings.poses_to_settle ? settings.creep : settings.settling;
                EXPECT_LE(glm::length(filter.pose().position - before.position),
                          fastest * frame_seconds * 1.001);
            }
        }
        rested = filter.rests();
        before = filter.pose();
    }
    EXPECT_TRUE(rested);
}

TEST(MotionFilter, WhatMovesIsFollowedWithItsVelocities) {
    MotionFilter filter;
    RoughEyes eyes(2e-4, 2e-3);
    const Vec3 velocity(0.1, -0.05, 0.2), spin(0.5, 1.0, -0.3);
    for (int i = 1; i <= 90; ++i) {
        const double t = i * frame_seconds;
        const Pose truth = at(t * velocity, turn_by(spin, t));
        filter.see({}, eyes.see(truth), covariance_of(eyes), i * frame);
        if (i > 20) {
            EXPECT_FALSE(filter.rests());
            EXPECT_LT(glm::length(filter.pose().position - truth.position), 1e-3);
            EXPECT_LT(angle_between(filter.pose().rotation, truth.rotation), 1e-2);
            EXPECT_LT(glm::length(filter.linear_velocity() - velocity), 0.05);
            EXPECT_LT(glm::length(filter.angular_velocity() - spin), 0.4);
        }
    }
    const Pose ahead = filter.at({}, 91 * frame);
    EXPECT_LT(glm::length(ahead.position - 91.0 * frame_seconds * velocity), 2e-3);
}

TEST(MotionFilter, WhatSetsOffIsNoticed) {
    MotionFilter filter;
    RoughEyes eyes(2e-4, 2e-3);
    int i = 1;
    for (; i <= 100; ++i) {
        filter.see({}, eyes.see(at({0.0, 0.0, 0.0})), covariance_of(eyes), i * frame);
    }
    ASSERT_TRUE(filter.rests());
    for (int k = 1; k <= 5; ++k, ++i) {
        filter.see({}, eyes.see(at({0.1 * k * frame_seconds, 0.0, 0.0})), covariance_of(eyes), i * frame);
    }
    EXPECT_FALSE(filter.rests());
    EXPECT_LT(std::abs(filter.pose().position.x - 0.5 * frame_seconds), 2e-3);
}

TEST(MotionFilter, WhatCreepsIsNotHeldBack) {
    MotionFilter filter;
    RoughEyes eyes(2e-4, 2e-3);
    double worst = 0.0;
    for (int i = 1; i <= 900; ++i) {
        const double x = 1e-3 * i * frame_seconds;
        filter.see({}, eyes.see(at({x, 0.0, 0.0})), covariance_of(eyes), i * frame);
        worst = std::max(worst, std::abs(filter.pose().position.x - x));
    }
    EXPECT_LT(worst, 1.2e-3);
}

// A turn about an axis that nobody can see says nothing; what is seen across it does.
TEST(MotionFilter, WhatIsSeenBadlyDoesNotCount) {
    MotionFilter filter;
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(0.0, 1.0);
    Matrix6 covariance = covariance_of(2e-4, 2e-3);
    covariance[4][4] = 0.25;
    for (int i = 1; i <= 300; ++i) {
        const Vec3 turn(2e-3 * normal(random), 0.5 * normal(random), 2e-3 * normal(random));
        const Vec3 place(2e-4 * normal(random), 2e-4 * normal(random), 2e-4 * normal(random));
        filter.see({}, {place, turn_by(turn, 1.0)}, covariance, i * frame);
    }
    EXPECT_TRUE(filter.rests());
    const Vec3 up = filter.pose().rotation * Vec3(0.0, 1.0, 0.0);
    EXPECT_LT(std::acos(up.y), 5e-3);
}

// Chance that differs from axis to axis, and turns with the body: covariances stay what they are, whatever
// rounding does to them.
TEST(MotionFilter, StaysSoundWhenChanceTurnsWithTheBody) {
    MotionFilter filter;
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(0.0, 1.0);
    const Vec3 spin(0.5, 0.8, -0.4), variances(1e-6, 0.09, 1e-6);
    for (int i = 1; i <= 900; ++i) {
        const double t = i * frame_seconds;
        const Quat rotation = turn_by(spin, t);
        const Mat3 axes = glm::mat3_cast(rotation);
        Matrix6 covariance = covariance_of(1e-4, 0.0);
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                double sum = 0.0;
                for (int k = 0; k < 3; ++k) {
                    sum += axes[k][a] * variances[k] * axes[k][b];
                }
                covariance[static_cast<std::size_t>(a) + 3][static_cast<std::size_t>(b) + 3] = sum;
            }
        }
        const Quat seen = rotation * turn_by({1e-3 * normal(random), 0.0, 1e-3 * normal(random)}, 1.0);
        filter.see({}, at({0.1 * t, 0.0, 0.0}, glm::normalize(seen)), covariance, i * frame);
        if (i > 30) {
            ASSERT_LT(angle_between(filter.pose().rotation, rotation), 0.02) << i;
            ASSERT_LT(std::abs(filter.pose().position.x - 0.1 * t), 1e-3) << i;
            ASSERT_LT(glm::length(filter.angular_velocity() - spin), 0.5) << i;
        }
    }
}

// A hand puts it elsewhere between two images: no velocity follows from that.
TEST(MotionFilter, WhatIsPutElsewhereIsThereAtOnceAndDoesNotFly) {
    for (const double way : {0.05, 0.2}) {
        MotionFilter filter;
        RoughEyes eyes(2e-4, 1e-3);
        for (int i = 1; i <= 120; ++i) {
            const Pose truth = at({i <= 60 ? 0.0 : way, 0.0, 0.0});
            filter.see({}, eyes.see(truth), covariance_of(eyes), i * frame);
            if (i > 60) {
                ASSERT_LT(glm::distance(filter.pose().position, truth.position), 1.5e-3) << way << ' ' << i;
                ASSERT_LT(glm::length(filter.linear_velocity()), 0.05) << way << ' ' << i;
            }
        }
        EXPECT_TRUE(filter.rests());
    }
}

TEST(MotionFilter, NonsenseChangesNothing) {
    MotionFilter filter;
    filter.see({}, at({1.0, 0.0, 0.0}), covariance_of(1e-3, 1e-2), frame);
    const double nan = std::nan("");
    filter.see({}, at({nan, 0.0, 0.0}), covariance_of(1e-3, 1e-2), 2 * frame);
    filter.see({}, at({2.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}), covariance_of(1e-3, 1e-2), 2 * frame);
    filter.see({}, at({2.0, 0.0, 0.0}), covariance_of(1e-3, 1e-2), frame);
    EXPECT_EQ(filter.pose().position, Vec3(1.0, 0.0, 0.0));
    // A covariance that is none: the pose is seen as well as any.
    filter.see({}, at({1.0, 0.0, 0.0}), covariance_of(nan, nan), 2 * frame);
    EXPECT_TRUE(std::isfinite(filter.pose().position.x));
}

}  // namespace
}  // namespace tactus::motion_filter_test
