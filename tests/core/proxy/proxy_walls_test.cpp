// The proxy never enters a surface and never passes one, however fast the hand and however bad the mesh.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "core/proxy/proxy.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/slow_distance.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_walls_test {
namespace {

using shared::RandomValues;
using shared::TouchRig;

double clearance(const TriangleMesh& mesh, const Vec3& p) {
    return static_cast<double>(shared::slow_distance(p, mesh));
}

TriangleMesh plate(double half) {
    return {{Vec3(-half, 0.0, -half), Vec3(half, 0.0, -half), Vec3(half, 0.0, half), Vec3(-half, 0.0, half)},
            {{0, 2, 1}, {0, 3, 2}}};
}

TEST(ProxyWalls, OneHundredMetresPerSecondDoNotPassASinglePlate) {
    RandomValues random(111);
    for (int i = 0; i < 500; ++i) {
        const double radius = random.magnitude(1e-5, 0.05);
        TouchRig rig(radius);
        rig.add(plate(1.0));
        const Vec3 from = random.in_box(0.4) + Vec3(0.0, 0.6, 0.0);
        rig.tick(from);
        Vec3 hand = from;
        for (int k = 0; k < 20; ++k) {
            hand.y = from.y - 0.1 * (k + 1);  // 100 m/s
            const ProxyTick tick = rig.tick(hand);
            ASSERT_GE(tick.position.y, radius) << "case " << i;
        }
        ASSERT_NEAR(rig.proxy.position().y, radius, 1e-6 * radius + 1e-12);
    }
}

TEST(ProxyWalls, AHandJumpingAboutABoxAtOneHundredMetresPerSecondStaysOutside) {
    RandomValues random(112);
    const Vec3 half(0.2, 0.3, 0.1);
    const TriangleMesh mesh = shared::box(half);
    for (const double radius : {0.05, 0.01, 1e-3}) {
        TouchRig rig(radius);
        rig.add(mesh);
        Vec3 hand(1.0, 0.0, 0.0);
        rig.tick(hand);
        for (int i = 0; i < 5'000; ++i) {
            hand = glm::clamp(hand + 0.1 * random.direction(), Vec3(-0.7), Vec3(0.7));
            const ProxyTick tick = rig.tick(hand);
            ASSERT_GE(clearance(mesh, tick.position), radius) << "tick " << i;
            const Vec3 inside = glm::abs(tick.position) - half;
            ASSERT_FALSE(inside.x < 0.0 && inside.y < 0.0 && inside.z < 0.0) << "tick " << i;
        }
    }
}

TEST(ProxyWalls, NeverEntersASoup) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const TriangleMesh mesh = shared::soup(60, 1.0, seed);
        RandomValues random(1000 + seed);
        TouchRig rig(0.03);
        rig.add(mesh);
        Vec3 hand(1.5, 0.0, 0.0);
        rig.tick(hand);
        for (int i = 0; i < 2'000; ++i) {
            hand = glm::clamp(hand + random.in_ball(random.flip() ? 0.1 : 0.01), Vec3(-1.2), Vec3(1.2));
            ASSERT_GE(clearance(mesh, rig.tick(hand).position), 0.03) << "seed " << seed << ", tick " << i;
        }
    }
}

// Above an edge so sharp or so flat that planes are nearly parallel.
TEST(ProxyWalls, WedgesFromHalfADegreeToNearlyFlatKeepTheProxyOutside) {
    RandomValues random(113);
    for (const double degrees : {0.5, 2.0, 20.0, 90.0, 170.0, 179.5}) {
        const TriangleMesh mesh = shared::groove(degrees * std::numbers::pi / 180.0, 4.0);
        for (const bool inside : {true, false}) {
            TouchRig rig(0.02);
            rig.add(mesh);
            Vec3 hand(0.0, inside ? 1.0 : -0.5, 0.0);
            if (inside && clearance(mesh, hand) < 0.02) {
                hand.y = 3.95;  // between the walls' rims there is room
            }
            if (clearance(mesh, hand) < 0.02) {
                continue;
            }
            rig.tick(hand);
            for (int i = 0; i < 1'500; ++i) {
                hand = glm::clamp(hand + random.in_ball(0.05), Vec3(-0.5, -0.5, -1.0), Vec3(0.5, 2.0, 1.0));
                ASSERT_GE(clearance(mesh, rig.tick(hand).position), 0.02)
                    << degrees << " degrees, tick " << i;
            }
        }
    }
}

TEST(ProxyWalls, AThinPlateIsNotPassedByRubbingAtItsEdges) {
    // Two sheets, 1e-7 m apart, touched on both sides and around the rim.
    TriangleMesh mesh = plate(0.3);
    const TriangleMesh other = plate(0.3);
    for (const auto& [a, b, c] : other.triangles) {
        mesh.triangles.push_back({a + 4, b + 4, c + 4});
    }
    for (const Vec3& v : other.vertices) {
        mesh.vertices.push_back(v - Vec3(0.0, 1e-7, 0.0));
    }
    RandomValues random(114);
    TouchRig rig(0.01);
    rig.add(mesh);
    Vec3 hand(0.0, 0.2, 0.0);
    rig.tick(hand);
    for (int i = 0; i < 20'000; ++i) {
        hand = glm::clamp(hand + random.in_ball(0.05), Vec3(-0.4, -0.2, -0.4), Vec3(0.4, 0.2, 0.4));
        const Vec3 p = rig.tick(hand).position;
        ASSERT_GE(clearance(mesh, p), 0.01) << "tick " << i;
    }
}

TEST(ProxyWalls, AClosedMeshTouchedFromInsideKeepsTheProxyInside) {
    RandomValues random(115);
    const TriangleMesh mesh = shared::icosphere(2, 0.5);
    TouchRig rig(0.02);
    rig.add(mesh);
    Vec3 hand(0.0);
    rig.tick(hand);
    for (int i = 0; i < 2'000; ++i) {
        hand = random.flip() ? hand + random.in_ball(0.1) : random.in_ball(1.0);
        const Vec3 p = rig.tick(hand).position;
        ASSERT_GE(clearance(mesh, p), 0.02);
        ASSERT_LT(glm::length(p), 0.5);
    }
}

TEST(ProxyWalls, TJunctionsLeakNothing) {
    // A plane whose left half has one triangle where the right half has many: corners in the middle of an
    // edge.
    TriangleMesh mesh{
        {Vec3(-1.0, 0.0, -1.0), Vec3(0.0, 0.0, -1.0), Vec3(0.0, 0.0, 1.0), Vec3(-1.0, 0.0, 1.0)},
        {{0, 2, 1}, {0, 3, 2}}};
    constexpr int pieces = 37;
    for (int i = 0; i < pieces; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const double z0 = -1.0 + 2.0 * i / pieces;
        const double z1 = -1.0 + 2.0 * (i + 1) / pieces;
        mesh.vertices.insert(mesh.vertices.end(), {Vec3(0.0, 0.0, z0), Vec3(1.0, 0.0, z0), Vec3(1.0, 0.0, z1),
                                                   Vec3(0.0, 0.0, z1)});
        mesh.triangles.push_back({first, first + 2, first + 1});
        mesh.triangles.push_back({first, first + 3, first + 2});
    }
    for (const double radius : {0.05, 1e-4}) {
        TouchRig rig(radius);
        rig.add(mesh);
        rig.tick({0.1, 2.0 * radius, 0.0});
        for (int i = 0; i < 3'000; ++i) {
            const Vec3 hand(0.3 * std::sin(0.05 * i), -0.5 * radius, 0.9 * std::sin(0.003 * i));
            const ProxyTick tick = rig.tick(hand);
            ASSERT_GE(tick.position.y, radius);
            ASSERT_LT(glm::length(tick.position - Vec3(hand.x, radius, hand.z)), 1e-5 * radius + 1e-10)
                << "tick " << i;
        }
    }
}

// Concave edges must not stop a slide (what locks CHAI3D on terrains).
TEST(ProxyWalls, ATerrainIsSlidAcrossWithoutAStop) {
    const TriangleMesh mesh = shared::terrain(24, 2.0, 0.1);
    for (const double radius : {0.05, 0.01}) {
        TouchRig rig(radius);
        rig.add(mesh);
        Vec3 before = rig.tick({-0.9, 0.5, 0.0}).position;
        for (int i = 1; i <= 2'000; ++i) {
            const double x = -0.9 + 1.8 * i / 2'000;
            const ProxyTick tick = rig.tick({x, -0.3, 0.4 * std::sin(3.0 * x)});
            ASSERT_GE(clearance(mesh, tick.position), radius) << "tick " << i;
            ASSERT_EQ(tick.status & proxy_unfinished, 0u) << "tick " << i;
            before = tick.position;
        }
        EXPECT_GT(before.x, 0.7);
    }
}

}  // namespace
}  // namespace tactus::proxy_walls_test
