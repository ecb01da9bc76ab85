// Fields of samples under the proxy: what meshes hold, volumes hold as well.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/mesh/iso_surface.hpp"
#include "shared/field_figures.hpp"
#include "shared/fields.hpp"
#include "shared/judge_tree.hpp"
#include "shared/poses.hpp"
#include "shared/random_values.hpp"
#include "shared/touch_rig.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::proxy_field_test {
namespace {

using shared::RandomValues;
using shared::TouchRig;

constexpr double radius = 0.01;

// A maze of walls that bend everywhere: a gyroid, cut off by the border of its samples.
TriangleMesh gyroid(std::uint32_t samples) {
    const double step = 0.4 / (samples - 1.0);
    const auto value = [](const Vec3& p) {
        const Vec3 q = 30.0 * p;
        return std::abs(std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) +
                        std::sin(q.z) * std::cos(q.x)) -
               0.3;
    };
    IsoSurface surface = iso_surface(shared::sampled({samples, samples, samples}, Vec3(step), value).get());
    EXPECT_EQ(surface.error, "");
    return std::move(surface.mesh);
}

TriangleMesh floor_of_samples() {
    IsoSurface surface = iso_surface(
        shared::sampled({32, 8, 32}, Vec3(0.02), [](const Vec3& p) { return p.y - 0.003; }).get());
    EXPECT_EQ(surface.error, "");
    return std::move(surface.mesh);
}

TEST(ProxyField, ASphereOfSamplesIsTheSphereWithinATenthOfACell) {
    const shared::FieldFigures figures = shared::play_field_sphere(64, 0.05, 4'000);
    EXPECT_GT(figures.contact_ticks, 1'000);
    EXPECT_EQ(figures.unfinished, 0);
    EXPECT_LT(figures.error_voxels, 0.1);
}

TEST(ProxyField, AHandThatJumpsThroughAMazeNeverPassesItsWalls) {
    const TriangleMesh mesh = gyroid(48);
    const shared::JudgeTree judge(mesh);
    TouchRig rig(radius);
    rig.add(mesh);
    RandomValues random(1403);
    Vec3 hand(0.3, 0.0, 0.0);
    rig.tick(hand);
    int touching = 0;
    for (int i = 0; i < 20'000; ++i) {
        hand = glm::clamp(hand + random.magnitude(1e-4, 0.1) * random.direction(), Vec3(-0.25), Vec3(0.25));
        const ProxyTick tick = rig.tick(hand);
        touching += (tick.status & proxy_touching) != 0;
        ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
        if (i % 50 == 0) {
            ASSERT_EQ(shared::winding(mesh, tick.position), 0) << "tick " << i;
        }
        ASSERT_TRUE(tick.status & (proxy_touching | proxy_unfinished) || tick.position == hand)
            << "tick " << i;
    }
    EXPECT_GT(touching, 5'000);
}

TEST(ProxyField, AHandAtRestMovesNothing) {
    TouchRig rig(radius);
    rig.add(gyroid(48), {}, {500.0, 0.0, 0.4, 0.3});
    RandomValues random(1405);
    int touching = 0;
    for (int i = 0; i < 40; ++i) {
        const Vec3 hand = random.in_box(0.19);
        const Vec3 from = rig.proxy.position();
        rig.draw(from, hand, 200);
        touching += (rig.draw(hand, hand, 50).status & proxy_touching) != 0;
        const Vec3 rest = rig.proxy.position();
        for (int k = 0; k < 200; ++k) {
            ASSERT_EQ(rig.tick(hand).position, rest) << "hand " << i;
        }
    }
    EXPECT_GT(touching, 10);
}

TEST(ProxyField, FrictionHoldsWithinItsConeAndSlidesBeyond) {
    TouchRig rig(radius);
    rig.add(floor_of_samples(), {}, {500.0, 0.0, 0.5, 0.5});
    const double top = 0.003 + radius;
    rig.draw({0.0, 0.1, 0.0}, {0.0, top - 0.01, 0.0}, 50);
    EXPECT_NEAR(rig.draw({0.0, top - 0.01, 0.0}, {0.0049, top - 0.01, 0.0}, 50).position.x, 0.0, 1e-6);
    EXPECT_NEAR(rig.draw({0.0049, top - 0.01, 0.0}, {0.1, top - 0.01, 0.0}, 500).position.x, 0.095, 5e-5);
}

TEST(ProxyField, AFieldThatMovesPushesAndCarries) {
    TouchRig rig(radius);
    const int body = rig.add(floor_of_samples(), shared::at({0.0, -0.2, 0.0}), {500.0, 0.0, 2.0, 2.0});
    const Vec3 hand(0.0);
    rig.tick(hand);
    for (int i = 1; i <= 400; ++i) {
        const double top = -0.197 + 0.001 * i;
        const ProxyTick tick = rig.tick(hand, body, shared::at({0.0, top - 0.003, 0.0}));
        ASSERT_NEAR(tick.position.y, std::max(0.0, top + radius), 1e-7) << i;
    }
    const Vec3 before = rig.proxy.position();
    for (int i = 1; i <= 50; ++i) {
        rig.tick(hand, body, shared::at({0.001 * i, 0.2, 0.0}));
    }
    EXPECT_NEAR(rig.proxy.position().x - before.x, 0.05, 1e-6);
}

TEST(ProxyField, ATickAllocatesLocksAndCallsNothing) {
    TouchRig rig(radius);
    rig.add(gyroid(48), {}, {500.0, 0.0, 0.4, 0.3});
    RandomValues random(1404);
    Vec3 hand(0.3, 0.0, 0.0);
    rig.tick(hand);
    testing::AuditScope audit;
    int touching = 0;
    for (int i = 0; i < 3'000; ++i) {
        hand = glm::clamp(hand + 0.003 * random.direction() - 0.002 * hand, Vec3(-0.25), Vec3(0.25));
        touching += (rig.tick(hand).status & proxy_touching) != 0;
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(audit.locks() + audit.waits() + audit.system_calls(), 0u) << audit.describe();
    EXPECT_GT(touching, 500);
}

}  // namespace
}  // namespace tactus::proxy_field_test
