#include "core/tool/part_balls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "shared/random_values.hpp"

namespace tactus::part_balls_test {
namespace {

using shared::RandomValues;

// Whatever the size, and however far from the origin, none is missed, and few
// are told that are not there.
TEST(PartBalls, TellsThoseWithinReachInTheirOrder) {
    RandomValues random(31);
    for (const double size : {1e-3, 1.0, 1e3}) {
        for (const double away : {0.0, 1e6}) {
            const Vec3 origin = away * random.direction();
            PartBalls balls(100);
            balls.clear(origin);
            std::vector<Vec3> centers;
            std::vector<double> radii;
            for (std::uint32_t i = 0; i < 100; ++i) {
                centers.push_back(origin + random.in_ball(size));
                radii.push_back(i == 37 ? std::numeric_limits<double>::infinity()
                                        : size * random.magnitude(1e-4, 0.3));
                balls.add(2 * i, centers.back(), radii.back());
            }
            for (int k = 0; k < 100; ++k) {
                const Vec3 point = origin + random.in_ball(1.5 * size);
                const double reach = size * random.magnitude(1e-4, 0.3);
                WorkBudget work(1'000);
                std::vector<std::uint32_t> told;
                balls.visit_within(point, reach, work, [&](std::uint32_t part) { told.push_back(part); });
                std::vector<std::uint32_t> within, nearly;
                for (std::uint32_t i = 0; i < 100; ++i) {
                    const double apart = glm::distance(point, centers[i]) - radii[i] - reach;
                    if (apart <= 0.0) {
                        within.push_back(2 * i);
                    }
                    if (apart <= 1e-5 * size) {
                        nearly.push_back(2 * i);
                    }
                }
                ASSERT_TRUE(std::ranges::includes(told, within));
                ASSERT_TRUE(std::ranges::includes(nearly, told));
                ASSERT_LT(work.left(), 1'000);
            }
        }
    }
}

TEST(PartBalls, OfNoneNoneIsTold) {
    PartBalls balls(8);
    WorkBudget work(10);
    balls.visit_within(Vec3(0.0), 1e9, work, [](std::uint32_t) { FAIL(); });
    EXPECT_TRUE(balls.is_empty());
    EXPECT_EQ(work.left(), 10);
}

}  // namespace
}  // namespace tactus::part_balls_test
