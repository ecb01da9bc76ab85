// Where more triangles are near than a tick can look at, the proxy still goes where it may.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/haptics/proxy.hpp"
#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/touch_rig.hpp"

namespace tactus {
namespace {

using shared::RandomValues;
using shared::TouchRig;

// Ticks in which the proxy stood still although it was not where it should be.
struct Watch {
    int frozen = 0, unfinished = 0, touching = 0;
    Vec3 before{1e9};

    void look(const ProxyTick& tick, const Vec3& hand, double radius) {
        unfinished += (tick.status & proxy_unfinished) != 0;
        touching += (tick.status & proxy_touching) != 0;
        frozen += (tick.status & proxy_unfinished) && tick.position == before &&
                  glm::distance(hand, tick.position) > 1e-3 * radius;
        before = tick.position;
    }
};

// A scan's noise: every vertex a share of an edge up or down.
TriangleMesh rough_sphere(int level, double radius, double share) {
    TriangleMesh mesh = shared::icosphere(level, 1.0);
    RandomValues random(7);
    const double edge = 1.1 / (1 << level);
    for (Vec3& v : mesh.vertices) {
        v *= radius * (1.0 + share * edge * random.between(-1.0, 1.0));
    }
    return mesh;
}

// The sphere's cube meets tens of thousands of boxes here.
TEST(ProxyBudget, OnARoughMeshOfAMillionTrianglesItIsNeverFrozen) {
    constexpr double radius = 0.05;
    const TriangleMesh mesh = rough_sphere(8, 0.5, 0.3);
    const shared::JudgeTree judge(mesh);
    TouchRig rig(radius);
    rig.add(mesh);
    Watch watch;
    for (int i = 0; i < 4'000; ++i) {
        const double angle = 0.001 * i;
        const double depth = 0.03 + 0.06 * std::sin(0.004 * i);
        const Vec3 hand =
            (0.5 + radius - depth) * Vec3(std::cos(angle), 0.3 * std::sin(3.0 * angle), std::sin(angle));
        const ProxyTick tick = rig.tick(hand);
        watch.look(tick, hand, radius);
        if (i % 50 == 0) {
            ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
        }
    }
    EXPECT_GT(watch.touching, 1'500);
    EXPECT_EQ(watch.frozen, 0);
    EXPECT_LT(watch.unfinished, 40);
}

// All of its 327,680 triangles are within one and a half radii of the centre.
TEST(ProxyBudget, InsideAFineBallItMovesAndStaysInside) {
    constexpr double radius = 0.05;
    const TriangleMesh mesh = shared::icosphere(7, 1.5 * radius);
    const shared::JudgeTree judge(mesh);
    TouchRig rig(radius);
    rig.add(mesh);
    RandomValues random(8);
    Watch watch;
    Vec3 hand(0.0);
    ASSERT_EQ(rig.tick(hand).status, 0u);
    for (int i = 0; i < 2'000; ++i) {
        hand = glm::clamp(hand + random.in_ball(0.2 * radius), Vec3(-radius), Vec3(radius));
        const ProxyTick tick = rig.tick(hand);
        watch.look(tick, hand, radius);
        ASSERT_LT(glm::length(tick.position), 0.5 * radius) << "tick " << i;
        ASSERT_LT(glm::distance(tick.position, hand), 1.3 * radius) << "tick " << i;
        ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
    }
    EXPECT_GT(watch.touching, 500);
    EXPECT_EQ(watch.frozen, 0);
    EXPECT_EQ(watch.unfinished, 0);
}

// More triangles touch the proxy than any list of contacts holds.
TEST(ProxyBudget, AHeapOfTinyTrianglesLetsItGo) {
    constexpr double radius = 0.05;
    RandomValues random(9);
    TriangleMesh mesh;
    for (int i = 0; i < 5'000; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const Vec3 at = random.in_ball(0.3 * radius);
        for (int k = 0; k < 3; ++k) {
            mesh.vertices.push_back(at + random.between(0.01, 0.05) * radius * random.direction());
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const shared::JudgeTree judge(mesh);
    TouchRig rig(radius);
    rig.add(mesh);
    Watch watch;
    Vec3 hand(2.0 * radius, 0.0, 0.0);
    rig.tick(hand);
    for (int i = 0; i < 3'000; ++i) {
        // Through the heap and out of it again, on all sides.
        const Vec3 goal = (i / 100) % 2 ? 2.0 * radius * random.direction() : Vec3(0.0);
        hand += 0.02 * (goal - hand);
        const ProxyTick tick = rig.tick(hand);
        watch.look(tick, hand, radius);
        ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
    }
    const Vec3 away(0.0, 3.0 * radius, 0.0);
    EXPECT_LT(glm::distance(rig.draw(hand, away, 200).position, away), 1e-9);
    EXPECT_GT(watch.touching, 1'000);
    EXPECT_EQ(watch.frozen, 0);
}

}  // namespace
}  // namespace tactus
