#include "core/math/least_turn.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tactus::least_turn_test {
namespace {

TEST(LeastTurn, TakesEveryDirectionToEveryOther) {
    std::vector<Vec3> directions;
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                if (x != 0 || y != 0 || z != 0) {
                    directions.push_back(glm::normalize(Vec3(x, y, z)));
                }
            }
        }
    }
    for (const Vec3& from : directions) {
        for (const Vec3& to : directions) {
            const Quat turn = least_turn(from, to);
            EXPECT_NEAR(glm::length(turn), 1.0, 1e-12);
            EXPECT_NEAR(glm::distance(turn * from, to), 0.0, 1e-9);
            EXPECT_NEAR(2.0 * std::acos(std::min(1.0, turn.w)),
                        std::acos(std::clamp(glm::dot(from, to), -1.0, 1.0)), 1e-7);
        }
    }
}

}  // namespace
}  // namespace tactus::least_turn_test
