// A tool among thousands of bodies, each with a shape of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/tool/tool_proxy.hpp"
#include "shared/many_bodies.hpp"
#include "shared/meshes.hpp"

namespace tactus {
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

}  // namespace
}  // namespace tactus
