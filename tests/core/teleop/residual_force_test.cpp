#include "core/teleop/residual_force.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "shared/random_values.hpp"

namespace tactus {
namespace {

constexpr double seconds = 5e-3;

// The far body gains what the model's does and `unexplained` besides.
MotionLesson lesson(const Vec3& unexplained, const Vec3& helped) {
    MotionLesson made;
    made.seconds = seconds;
    made.model = helped;
    made.truth = unexplained * seconds;
    return made;
}

void go_on(ResidualForce& residual, const Vec3& unexplained, int lessons, bool heard = true) {
    const ResidualSettings settings;
    for (int i = 0; i < lessons; ++i) {
        const Vec3 helped = residual.acceleration(settings) * seconds;
        if (heard) {
            residual.learn(settings, lesson(unexplained, helped), helped);
        }
        for (int k = 0; k < 5; ++k) {
            residual.tick(settings, 1e-3);
        }
    }
}

TEST(ResidualForce, FindsAForceWithinHalfASecond) {
    ResidualForce residual;
    const Vec3 force(-25.0, 0.0, 3.0);
    go_on(residual, force, 100);
    EXPECT_LT(glm::distance(residual.acceleration({}), force), 0.1 * glm::length(force));
}

TEST(ResidualForce, GoesWithTheForceAndWithSilence) {
    ResidualForce residual;
    go_on(residual, {0.0, 20.0, 0.0}, 200);
    ResidualForce other = residual;
    go_on(residual, Vec3(0.0), 120);
    EXPECT_LT(glm::length(residual.acceleration({})), 0.5);
    go_on(other, Vec3(0.0), 200, false);
    EXPECT_LT(glm::length(other.acceleration({})), 1.0);
}

TEST(ResidualForce, OneBlowIsNoForce) {
    ResidualForce residual;
    go_on(residual, Vec3(0.0), 50);
    go_on(residual, {200.0, 0.0, 0.0}, 1);
    EXPECT_LT(glm::length(residual.acceleration({})), 0.5);
}

TEST(ResidualForce, NoiseIsNoForce) {
    shared::RandomValues random(5);
    ResidualForce residual;
    double largest = 0.0;
    for (int i = 0; i < 2000; ++i) {
        go_on(residual, random.in_ball(3.0), 1);
        largest = std::max(largest, glm::length(residual.acceleration({})));
    }
    EXPECT_LT(largest, 1.0);
}

}  // namespace
}  // namespace tactus
