// Where the proxy comes to rest: the constrained minimum, whatever it rests on.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/proxy/proxy.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_rest_test {
namespace {

using shared::RandomValues;
using shared::TouchRig;

constexpr double radius = 0.05;
constexpr double tolerance = 2e-8 * radius;  // skin and arrival (tolerances.hpp)

TriangleMesh square(double half) {
    return {{Vec3(-half, 0.0, -half), Vec3(half, 0.0, -half), Vec3(half, 0.0, half), Vec3(-half, 0.0, half)},
            {{0, 2, 1}, {0, 3, 2}}};
}

Vec3 rest(TouchRig& rig, const Vec3& from, const Vec3& hand) {
    rig.draw(from, hand, 20);
    for (int i = 0; i < 5; ++i) {
        rig.tick(hand);
    }
    return rig.proxy.position();
}

TEST(ProxyRest, FollowsTheHandInTheOpen) {
    TouchRig rig(radius);
    rig.add(square(1.0));
    const Vec3 hand(0.1, 0.5, -0.2);
    const ProxyTick tick = rig.draw({0.0, 1.0, 0.0}, hand, 10);
    EXPECT_LT(glm::length(tick.position - hand), 1e-15);
    EXPECT_EQ(tick.status, 0u);
}

TEST(ProxyRest, OnAPlaneStraightAboveTheHand) {
    TouchRig rig(radius);
    rig.add(square(1.0));
    const Vec3 p = rest(rig, {0.0, 0.2, 0.0}, {0.1, -0.03, 0.2});
    EXPECT_LT(glm::length(p - Vec3(0.1, radius, 0.2)), tolerance);
    ASSERT_EQ(rig.proxy.touching().size(), 1u);
    EXPECT_NEAR(rig.proxy.touching()[0].pressure, radius + 0.03, tolerance);
}

TEST(ProxyRest, OnAnOpenMeshFromBelowAsFromAbove) {
    TouchRig rig(radius);
    rig.add(square(1.0));
    const Vec3 p = rest(rig, {0.0, -0.2, 0.0}, {0.1, 0.03, 0.2});
    EXPECT_LT(glm::length(p - Vec3(0.1, -radius, 0.2)), tolerance);
}

// The hand beside the edge of an open mesh, inside the inflated rim: the proxy stands on the rim's cylinder.
TEST(ProxyRest, OnAnEdgeWhereTheEdgesCylinderFacesTheHand) {
    TouchRig rig(radius);
    rig.add(square(1.0));
    const Vec3 hand(1.02, 0.01, 0.3);
    const Vec3 p = rest(rig, {1.3, 0.15, 0.3}, hand);
    const Vec3 axis(1.0, 0.0, 0.3);
    EXPECT_LT(glm::length(p - (axis + radius * glm::normalize(hand - axis))), 2.0 * tolerance);
}

TEST(ProxyRest, OnACornerWhereTheCornersSphereFacesTheHand) {
    TouchRig rig(radius);
    rig.add(square(1.0));
    const Vec3 corner(1.0, 0.0, 1.0);
    const Vec3 hand = corner + Vec3(0.012, 0.006, 0.017);
    const Vec3 p = rest(rig, corner + Vec3(0.2, 0.1, 0.25), hand);
    EXPECT_LT(glm::length(p - (corner + radius * glm::normalize(hand - corner))), 2.0 * tolerance);
}

// What is planes stays planes: the step that leads to rest is known to be the last one.
TEST(ProxyRest, AWayOverAFlatSideIsOneStep) {
    for (const bool closed_form : {false, true}) {
        TouchRig rig(radius);
        closed_form ? rig.add(BoxShape{Vec3(1.0)}, {Vec3(0.0, -1.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)})
                    : rig.add(square(1.0));
        rig.draw({-0.6, 0.1, -0.1}, {-0.6, -0.03, -0.1}, 20);
        for (int i = 1; i <= 100; ++i) {
            const Vec3 hand(-0.6 + 0.012 * i, -0.03 - 1e-4 * i, -0.1);
            const ProxyTick tick = rig.tick(hand);
            ASSERT_EQ(tick.steps, 1) << closed_form << ' ' << i;
            ASSERT_EQ(tick.status, static_cast<std::uint32_t>(proxy_touching));
            ASSERT_LT(glm::distance(tick.position, Vec3(hand.x, radius, hand.z)), tolerance);
            ASSERT_NEAR(rig.proxy.touching()[0].pressure, radius - hand.y, tolerance);
            ASSERT_LT(glm::distance(rig.proxy.touching()[0].point, Vec3(hand.x, 0.0, hand.z)), tolerance);
        }
    }
}

// A step around an edge or a ball ends exactly above the place of rest, and what is left is to drop.
TEST(ProxyRest, AWayAroundWhatIsRoundIsOneStep) {
    for (const bool closed_form : {false, true}) {
        TouchRig rig(radius);
        closed_form ? rig.add(SphereShape{0.2}, {Vec3(1.0, 0.0, 0.3), Quat(1.0, 0.0, 0.0, 0.0)})
                    : rig.add(square(1.0));
        const double rest = radius + (closed_form ? 0.2 : 0.0);
        const Vec3 axis(1.0, 0.0, 0.3);
        rig.draw(axis + Vec3(0.3, 0.3, 0.0), axis + 0.7 * rest * glm::normalize(Vec3(1.0)), 20);
        for (int i = 0; i < 5; ++i) {
            rig.tick(axis + 0.7 * rest * glm::normalize(Vec3(1.0, 1.0, 0.0)));
        }
        for (int i = 1; i <= 40; ++i) {
            const double angle = 0.25 * std::numbers::pi + 0.01 * i;
            const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
            const Vec3 hand = axis + 0.7 * rest * out;
            const ProxyTick tick = rig.tick(hand);
            ASSERT_EQ(tick.steps, 1) << closed_form << ' ' << i;
            ASSERT_LT(glm::distance(tick.position, axis + rest * out), 2.0 * tolerance);
            ASSERT_EQ(rig.proxy.touching().size(), 1u);
            ASSERT_LT(glm::distance(rig.proxy.touching()[0].normal, out), 1e-7);
            ASSERT_NEAR(rig.proxy.touching()[0].pressure, 0.3 * rest, 2.0 * tolerance);
        }
    }
}

// A sweep lets the sphere come nearer to the other side than it rests, by half a skin: over the slope, 2e-6
// too far along the valley's floor. The end of a way is more than that.
TEST(ProxyRest, InAValleyThatIsAllButFlat) {
    constexpr double slope = 1e-4;
    TouchRig rig(radius);
    rig.add(TriangleMesh{{Vec3(-1.0, 0.0, -1.0), Vec3(0.0, 0.0, -1.0), Vec3(1.0, slope, -1.0),
                          Vec3(-1.0, 0.0, 1.0), Vec3(0.0, 0.0, 1.0), Vec3(1.0, slope, 1.0)},
                         {{0, 3, 1}, {1, 3, 4}, {1, 4, 2}, {2, 4, 5}}});
    rest(rig, {-0.02, 0.2, 0.1}, {-0.02, -0.03, 0.1});
    const double bottom = -radius * std::tan(0.5 * std::atan(slope));
    const ProxyTick tick = rig.tick({bottom + 2e-6, -0.03, 0.1});
    EXPECT_EQ(tick.status, static_cast<std::uint32_t>(proxy_touching));
    EXPECT_LT(glm::distance(tick.position, Vec3(bottom, radius, 0.1)), 2e-8);
}

class ProxyGroove : public ::testing::TestWithParam<double> {};

TEST_P(ProxyGroove, RestsOnBothWallsWithTheRightPressure) {
    const double angle = GetParam() * std::numbers::pi / 180.0;
    TouchRig rig(radius);
    rig.add(shared::groove(angle, 10.0));
    const double height = radius / std::sin(0.5 * angle);
    const double depth = 0.03;
    const Vec3 hand(0.0, height - depth, 0.4);
    const Vec3 p = rest(rig, {0.0, std::min(height + 0.3, 0.9), 0.3}, hand);
    // Both walls' skins add up to skin / sin(angle / 2) above the bottom.
    EXPECT_LT(glm::length(p - Vec3(0.0, height, 0.4)), tolerance / std::sin(0.5 * angle) + tolerance);
    ASSERT_EQ(rig.proxy.touching().size(), 2u);
    double held = 0.0;
    for (const Touch& contact : rig.proxy.touching()) {
        held += contact.pressure * contact.normal.y;
    }
    EXPECT_NEAR(held, depth, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Angles, ProxyGroove, ::testing::Values(10.0, 30.0, 60.0, 90.0, 120.0, 150.0, 175.0));

TEST(ProxyRest, InACornerOfThreePlanes) {
    TouchRig rig(radius);
    TriangleMesh corner;
    corner.vertices = {Vec3(0.0), Vec3(2.0, 0.0, 0.0), Vec3(0.0, 2.0, 0.0), Vec3(0.0, 0.0, 2.0)};
    corner.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
    rig.add(corner);
    const Vec3 p = rest(rig, {0.3, 0.3, 0.3}, {-0.1, -0.2, -0.15});
    EXPECT_LT(glm::length(p - Vec3(radius)), 3.0 * tolerance);
    EXPECT_EQ(rig.proxy.touching().size(), 3u);
}

TEST(ProxyRest, InAPitOfManyFacets) {
    for (const int sides : {3, 4, 5, 7, 12, 40, 100}) {
        TriangleMesh pit;
        pit.vertices.push_back(Vec3(0.0));
        for (int i = 0; i < sides; ++i) {
            const double a = 2.0 * std::numbers::pi * i / sides;
            pit.vertices.push_back({std::cos(a), 1.0, std::sin(a)});
        }
        for (int i = 0; i < sides; ++i) {
            pit.triangles.push_back(
                {0, static_cast<std::uint32_t>(1 + i), static_cast<std::uint32_t>(1 + (i + 1) % sides)});
        }
        TouchRig rig(radius);
        rig.add(pit);
        const double slope =
            std::cos(std::numbers::pi / sides);  // distance of a facet's rim from the axis at height 1
        const double height = radius * std::hypot(1.0, slope) / slope;
        const Vec3 p = rest(rig, {0.02, 0.5, 0.01}, {0.0, -0.1, 0.0});
        EXPECT_LT(glm::length(p - Vec3(0.0, height, 0.0)), 1e-7) << sides;
    }
}

TEST(ProxyRest, OnABoxOfTrianglesAsOnTheBoxInClosedForm) {
    RandomValues random(101);
    const Vec3 half(0.4, 0.3, 0.5);
    for (int i = 0; i < 200; ++i) {
        TouchRig triangles(radius), closed(radius);
        triangles.add(shared::box(half));
        closed.add(BoxShape{half});
        const Vec3 from = 1.5 * random.direction();
        const Vec3 hand = from * random.between(0.05, 0.5);
        const Vec3 p = rest(triangles, from, hand);
        const Vec3 q = rest(closed, from, hand);
        ASSERT_LT(glm::length(p - q), 1e-7) << "case " << i;
    }
}

TEST(ProxyRest, OnAFineSphereCloseToTheSphereInClosedForm) {
    RandomValues random(102);
    TouchRig closed(radius);
    closed.add(SphereShape{1.0});
    const Vec3 from = 1.3 * random.direction();
    const Vec3 hand = 0.97 * glm::normalize(from);
    EXPECT_LT(glm::length(rest(closed, from, hand) - (1.0 + radius) * glm::normalize(hand)), 1e-8);
    TouchRig fine(radius);
    fine.add(shared::icosphere(5, 1.0));
    EXPECT_LT(std::abs(glm::length(rest(fine, from, hand)) - (1.0 + radius)), 1e-3);
}

TEST(ProxyRest, ScaleDoesNotMatter) {
    for (const double scale : {1e-3, 1.0, 1e3}) {
        TouchRig rig(radius * scale);
        TriangleMesh mesh = shared::groove(1.2, 10.0);
        for (Vec3& v : mesh.vertices) {
            v *= scale;
        }
        rig.add(mesh);
        const double height = radius / std::sin(0.6);
        const Vec3 p = rest(rig, scale * Vec3(0.0, 0.5, 0.1), scale * Vec3(0.0, 0.0, 0.1)) / scale;
        EXPECT_LT(glm::length(p - Vec3(0.0, height, 0.1)), 3.0 * tolerance) << scale;
    }
}

TEST(ProxyRest, FarFromTheOriginAsGoodAsTheCoordinates) {
    const Vec3 place(1e4, -1e4, 1e4);
    TouchRig rig(radius);
    TriangleMesh mesh = shared::groove(1.2, 10.0);
    for (Vec3& v : mesh.vertices) {
        v += place;
    }
    rig.add(mesh);
    const double height = radius / std::sin(0.6);
    const Vec3 p = rest(rig, place + Vec3(0.0, 0.5, 0.1), place + Vec3(0.0, 0.0, 0.1));
    EXPECT_LT(glm::length(p - place - Vec3(0.0, height, 0.1)), 1e-8);
}

TEST(ProxyRest, AHandThatStartsInsideIsAbsentUntilItIsOut) {
    TouchRig rig(radius);
    rig.add(BoxShape{Vec3(0.5)});
    EXPECT_TRUE(rig.tick(Vec3(0.1, 0.2, 0.0)).status & proxy_absent);
    EXPECT_TRUE(rig.tick(Vec3(0.0, 0.52, 0.0)).status & proxy_absent);
    const ProxyTick out = rig.tick(Vec3(0.0, 0.7, 0.0));
    EXPECT_EQ(out.status & proxy_absent, 0u);
    EXPECT_NEAR(rig.tick(Vec3(0.0, 0.4, 0.0)).position.y, 0.55, 1e-8);
}

TEST(ProxyRest, AHandThatStartsInsideAClosedMeshIsAbsentOnlyNearItsSurface) {
    TouchRig rig(radius);
    rig.add(shared::box(Vec3(0.5)));
    EXPECT_TRUE(rig.tick(Vec3(0.0, 0.48, 0.0)).status & proxy_absent);
    EXPECT_EQ(rig.tick(Vec3(0.0, 0.2, 0.0)).status & proxy_absent, 0u);  // room within: touched from inside
    EXPECT_NEAR(rig.tick(Vec3(0.0, 0.7, 0.0)).position.y, 0.45, 1e-8);
}

TEST(ProxyRest, AHandThatStartsTouchingGetsNoKick) {
    TouchRig rig(radius);
    rig.add(square(1.0));
    const ProxyTick tick = rig.tick({0.0, radius, 0.0});
    EXPECT_EQ(tick.status & proxy_absent, 0u);
    EXPECT_LT(glm::length(tick.position - Vec3(0.0, radius, 0.0)), 1e-3 * radius);
}

TEST(ProxyRest, AStillHandMovesNothingNotEvenTheLastBit) {
    RandomValues random(103);
    for (int scene = 0; scene < 4; ++scene) {
        TouchRig rig(radius);
        const TouchMaterial rough{500.0, 0.0, 0.3, 0.2};
        switch (scene) {
            case 0:
                rig.add(shared::icosphere(4, 1.0));
                break;
            case 1:
                rig.add(shared::icosphere(4, 1.0), {}, rough);
                break;
            case 2:
                rig.add(shared::groove(1.0, 10.0), {Vec3(0.0, 0.95, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}, rough);
                break;
            default:
                rig.add(CylinderShape{0.5, 1.0});
                break;
        }
        const Vec3 hand(0.03, 0.97, 0.02);
        rig.draw({0.2, 1.4, 0.1}, hand, 50);
        for (int i = 0; i < 100; ++i) {
            rig.tick(hand);
        }
        const Vec3 settled = rig.proxy.position();
        for (int i = 0; i < 100'000; ++i) {
            const ProxyTick tick = rig.tick(hand);
            ASSERT_EQ(tick.position, settled) << "scene " << scene << ", tick " << i;
        }
    }
}

TEST(ProxyRest, TheSameInputsGiveTheSameBits) {
    const auto run = [] {
        TouchRig rig(radius);
        rig.add(shared::terrain(32, 2.0, 0.2));
        std::vector<Vec3> way;
        for (int i = 0; i < 5'000; ++i) {
            way.push_back(
                rig.tick({0.8 * std::sin(0.003 * i), 0.1 * std::sin(0.02 * i), 0.7 * std::cos(0.002 * i)})
                    .position);
        }
        return way;
    };
    EXPECT_EQ(run(), run());
}

TEST(ProxyRest, AMaskedBodyIsAir) {
    TouchRig rig(radius);
    const int body = rig.add(square(1.0));
    rig.scene.set_layer(body, 2);
    ProxySettings settings = rig.proxy.settings();
    settings.mask = 1;
    rig.proxy.set_settings(settings);
    EXPECT_EQ(rig.draw({0.0, 0.3, 0.0}, {0.0, -0.3, 0.0}, 10).position, Vec3(0.0, -0.3, 0.0));
}

TEST(ProxyRest, AfterADisplacementSurfacesAreThere) {
    TouchRig rig(radius);
    rig.add(square(1.0), {Vec3(0.0, -20.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)});
    for (int i = 0; i < 100; ++i) {
        rig.tick({0.0, 0.1, 0.0});
    }
    rig.proxy.displace({0.0, -20.0, 0.0});
    EXPECT_NEAR(rig.draw({0.0, -19.9, 0.0}, {0.0, -20.1, 0.0}, 10).position.y, -20.0 + radius, 1e-6);
}

TEST(ProxyRest, AfterAPauseBodiesAreWhereTheyWentMeanwhile) {
    TouchRig rig(radius);
    const int body = rig.add(square(1.0), {Vec3(0.0, -20.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)});
    for (int i = 0; i < 100; ++i) {
        rig.tick({0.0, 0.1, 0.0});
    }
    // The scene ticks on without this proxy, and the body comes up to it.
    for (int i = 1; i <= 200; ++i) {
        rig.scene.begin_tick();
        rig.scene.set_pose(body, {Vec3(0.0, -20.0 + 0.1 * i, 0.0), Quat(1.0, 0.0, 0.0, 0.0)});
    }
    rig.scene.begin_tick();
    rig.proxy.restart();
    rig.tick({0.0, 0.1, 0.0});
    EXPECT_NEAR(rig.draw({0.0, 0.1, 0.0}, {0.0, -0.1, 0.0}, 10).position.y, radius, 1e-6);
}

// The proxy is let go and put elsewhere (a device exchanged, a node switched off and on): what it remembered
// of its surroundings must not hold for the new place.
TEST(ProxyRest, AfterARestartElsewhereSurfacesAreThere) {
    TouchRig rig(radius);
    rig.add(square(1.0));
    rig.add(square(1.0), {Vec3(50.0, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)});
    for (int i = 0; i < 100; ++i) {
        rig.tick({0.0, 0.1, 0.0});
    }
    rig.proxy.restart();
    rig.tick({50.0, 0.1, 0.0});
    EXPECT_NEAR(rig.draw({50.0, 0.1, 0.0}, {50.0, -0.1, 0.0}, 10).position.y, radius, 1e-6);
}

TEST(ProxyRest, AHandThatIsNoNumberIsPassedOver) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -infinity, 1e300}) {
        for (const double height : {0.5, 0.8}) {  // in touch, and in the open
            TouchRig rig(radius);
            rig.add(shared::box(Vec3(0.5)));
            const Vec3 before = rig.draw({0.0, 0.9, 0.0}, {0.0, height, 0.0}, 10).position;
            EXPECT_LT(glm::distance(rig.tick({0.0, bad, 0.0}).position, before), 1e-9) << bad;
            EXPECT_LT(glm::distance(rig.tick({0.0, height, 0.0}).position, before), 1e-9) << bad;
        }
    }
}

}  // namespace
}  // namespace tactus::proxy_rest_test
