#include "core/tool/part_balls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "core/tool/tool_proxy.hpp"
#include "shared/many_bodies.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus {
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

// A bar is led through a heap of a thousand balls and out of it again: it
// enters none, and is at the hand.
TEST(ToolAmongMany, ThroughAHeapItGoesRoundAllAndComesOut) {
    shared::ManyBodies balls = shared::heap_of_balls(1'000, 0.05);
    const auto shape = make_tool_shape(shared::box(Vec3(0.05, 0.01, 0.01)), {1e-3, 100}).shape;
    ToolProxy tool(shape, balls.places.size(), {});
    const Quat upright(1.0, 0.0, 0.0, 0.0);
    int touching = 0;
    for (int i = 0; i < 1'000; ++i) {
        balls.tick();
        const Vec3 hand(0.2 - 4e-4 * i, 0.02 * std::sin(0.01 * i), 0.03 * std::sin(0.003 * i));
        const ToolTick tick = tool.move(balls.scene, {hand, upright});
        touching += (tick.status & tool_touching) != 0;
        EXPECT_LE(tool.work_spent(), ToolSettings{}.max_work + 2'000) << i;
        for (std::size_t k = static_cast<std::size_t>(i) % 7; k < balls.places.size(); k += 7) {
            for (const ToolSphere& sphere : shape->spheres) {
                ASSERT_GE(glm::distance(to_parent(tick.pose, sphere.center), balls.places[k]),
                          (sphere.radius + 0.01) * (1.0 - 1e-6))
                    << i;
            }
        }
    }
    EXPECT_GT(touching, 50);
    ToolTick last;
    for (int i = 0; i < 200; ++i) {
        balls.tick();
        last = tool.move(balls.scene, {Vec3(-0.3, 0.3, 0.0), upright});
    }
    EXPECT_LT(glm::distance(last.pose.position, Vec3(-0.3, 0.3, 0.0)), 1e-3);
}

}  // namespace
}  // namespace tactus
