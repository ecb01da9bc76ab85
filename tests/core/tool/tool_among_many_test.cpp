// A tool among thousands of bodies, each with a shape of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/tool/tool_proxy.hpp"
#include "shared/many_bodies.hpp"
#include "shared/meshes.hpp"

namespace tactus::tool_among_many_test {
namespace {

// A bar is led through a heap of a thousand balls and out of it again: it enters none, and is at the hand.
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

// A bar below a ceiling of so many balls that tremble, and one more ball that comes up under it, last of all.
struct Pushed {
    double deepest = 0.0;         // the ball was in one of the tool's spheres (of its radius)
    double deepest_unsaid = 0.0;  // the same, in ticks that do not say that the tool is let go
    double highest = 0.0;         // the tool has come (unit: meters)
};

Pushed push(int trembling, double step) {
    std::vector<Vec3> places;
    for (int i = 0; i < trembling; ++i) {
        places.emplace_back(-0.05 + 0.0025 * (i % 40), 0.04, -0.05 + 0.0025 * (i / 40));
    }
    places.emplace_back(0.0, -0.05, 0.0);
    shared::ManyBodies balls(SphereShape{0.01}, places);
    const auto shape = make_tool_shape(shared::box(Vec3(0.05, 0.01, 0.01)), {1e-3, 400}).shape;
    ToolProxy tool(shape, places.size(), {});
    const Quat upright(1.0, 0.0, 0.0, 0.0);
    Pushed pushed;
    Vec3 ball = places.back();
    for (int i = 0; i < 40; ++i) {
        balls.tick(1e-5);
        ball.y = i < 20 ? ball.y : std::min(-0.013, ball.y + step);
        balls.scene.set_pose(trembling, {ball, upright});
        const ToolTick tick = tool.move(balls.scene, {Vec3(0.0), upright});
        const bool says = (tick.status & (tool_squeezed | tool_absent)) != 0;
        for (const ToolSphere& sphere : shape->spheres) {
            const double gap =
                glm::distance(to_parent(tick.pose, sphere.center), ball) - 0.01 - sphere.radius;
            pushed.deepest = std::max(pushed.deepest, -gap / sphere.radius);
            pushed.deepest_unsaid = says ? pushed.deepest_unsaid : pushed.deepest;
        }
        pushed.highest = std::max(pushed.highest, tick.pose.position.y);
    }
    return pushed;
}

TEST(ToolAmongMany, WhatComesLastOfAThousandTakesItAlong) {
    for (const double step : {0.004, 0.009, 0.016}) {
        const Pushed pushed = push(1'000, step);
        EXPECT_LT(pushed.deepest, 0.01) << step;
        EXPECT_GT(pushed.highest, 0.006) << step;
    }
}

TEST(ToolAmongMany, AmongMoreThanATickCanAskItSaysThatItIsLetGo) {
    for (const double step : {0.004, 0.009, 0.016}) {
        EXPECT_LT(push(3'900, step).deepest_unsaid, 0.5) << step;
    }
}

}  // namespace
}  // namespace tactus::tool_among_many_test
