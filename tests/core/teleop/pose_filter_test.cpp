#include "core/teleop/pose_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace tactus {
namespace {

constexpr double between = 0.005;

BodyMotion at(const Vec3& position, const Vec3& velocity = Vec3(0.0)) {
    BodyMotion made;
    made.pose.position = position;
    made.linear_velocity = velocity;
    return made;
}

TEST(PoseFilter, AnHonestFarSideIsBelievedToTheBit) {
    const PoseFilterSettings settings;
    PoseFilter filter;
    for (int i = 0; i < 500; ++i) {
        const Vec3 place(0.001 * i, std::sin(0.1 * i) * 1e-3, 0.0);
        const BodyMotion received = at(place, {0.2, 0.0, 0.0});
        EXPECT_EQ(filter.filter(settings, received, at(place + Vec3(2e-5, 0.0, 1e-5)), between).pose.position,
                  place);
    }
}

TEST(PoseFilter, ABodyThatIsReallyElsewhereIsBelievedAtOnce) {
    const PoseFilterSettings settings;
    PoseFilter filter;
    for (int i = 0; i < 200; ++i) {
        filter.filter(settings, at(Vec3(0.0)), at(Vec3(0.0)), between);
    }
    const BodyMotion there = at({0.2, 0.0, 0.0});
    EXPECT_EQ(filter.filter(settings, there, at(Vec3(0.0)), between).pose.position, there.pose.position);
}

// The model begins from the last place that was believed and errs by 0.2 mm a state.
double error_with_noise(double deviation, const Vec3& velocity) {
    const PoseFilterSettings settings;
    PoseFilter filter;
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal(0.0, deviation);
    Vec3 truth(0.0), believed(0.0);
    double sum = 0.0;
    constexpr int states = 4000;
    for (int i = 0; i < states; ++i) {
        truth += velocity * between;
        const Vec3 expected = believed + velocity * between * 1.02;
        const Vec3 seen = truth + Vec3(normal(random), normal(random), normal(random));
        believed = filter.filter(settings, at(seen, velocity), at(expected), between).pose.position;
        sum += i > 400 ? glm::distance(believed, truth) : 0.0;
    }
    return sum / (states - 400);
}

TEST(PoseFilter, ChanceIsTakenOutWhileABodyMovesAndMoreSoAtRest) {
    constexpr double deviation = 1e-3;
    const double unfiltered = deviation * std::sqrt(8.0 / 3.14159265358979);
    EXPECT_LT(error_with_noise(deviation, {0.2, 0.0, 0.0}), 0.4 * unfiltered);
    EXPECT_LT(error_with_noise(deviation, Vec3(0.0)), 0.15 * unfiltered);
}

}  // namespace
}  // namespace tactus
