#include "core/safety/limited_force.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>

namespace tactus::limited_force_test {
namespace {

TEST(LimitedForce, IsShorterAndKeepsTheDirection) {
    EXPECT_EQ(limited_force({0.0, 3.0, 0.0}, 8.0), Vec3(0.0, 3.0, 0.0));
    EXPECT_LT(glm::length(limited_force({0.0, 30.0, 40.0}, 5.0) - Vec3(0.0, 3.0, 4.0)), 1e-12);
}

TEST(LimitedForce, IsNoneWhereItIsNoNumber) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(limited_force({nan, 0.0, 0.0}, 8.0), Vec3(0.0));
    EXPECT_EQ(limited_force({infinity, 0.0, 0.0}, 8.0), Vec3(0.0));
}

}  // namespace
}  // namespace tactus::limited_force_test
