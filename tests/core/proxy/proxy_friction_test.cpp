// Friction by Coulomb: in one plane and in grooves the proxy stays back by what the walls can hold, no more,
// no less.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "core/haptics/force_law.hpp"
#include "core/proxy/proxy.hpp"
#include "shared/meshes.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_friction_test {
namespace {

using shared::TouchRig;

constexpr double radius = 0.05;

TouchMaterial rough(double static_friction, double dynamic_friction) {
    return {1000.0, 0.0, static_friction, dynamic_friction};
}

// Tangential over normal force while the hand is drawn along z at constant depth, for walls at `angle` (pi: a
// plane).
double measured_ratio(double angle, double friction) {
    TouchRig rig(radius);
    rig.add(shared::groove(angle, 20.0), {}, rough(friction, friction));
    const double height = radius / std::sin(0.5 * angle);
    const double depth = 0.02;
    const Vec3 above(0.0, height + 0.01, -2.0);
    rig.draw(above, {0.0, height - depth, -2.0}, 20);
    const Vec3 hand(0.0, height - depth, 2.0);
    const ProxyTick tick = rig.draw({0.0, height - depth, -2.0}, hand, 4'000);
    const HandForce force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3);
    EXPECT_TRUE(tick.status & proxy_sliding);
    double pressing = 0.0;
    for (const Touch& contact : rig.proxy.touching()) {
        pressing += contact.pressure;
    }
    EXPECT_NEAR(force.total.z, -1000.0 * (hand.z - tick.position.z), 1e-6);
    return -force.total.z / (1000.0 * pressing);
}

class ProxyFriction : public ::testing::TestWithParam<double> {};

TEST_P(ProxyFriction, SlidesAtTheDynamicCoefficientWithinHalfAPercent) {
    const double angle = GetParam() * std::numbers::pi / 180.0;
    for (const double friction : {0.1, 0.5, 1.0}) {
        EXPECT_NEAR(measured_ratio(angle, friction) / friction, 1.0, 5e-3) << "friction " << friction;
    }
}

INSTANTIATE_TEST_SUITE_P(Angles, ProxyFriction, ::testing::Values(30.0, 60.0, 90.0, 120.0, 150.0, 180.0));

// The pressures of a groove's walls follow from the depth alone: depth / (2 sin(angle / 2)) each.
TEST(ProxyFriction, WallsOfAGroovePressAsStaticsSays) {
    for (const double degrees : {60.0, 90.0, 120.0}) {
        const double angle = degrees * std::numbers::pi / 180.0;
        TouchRig rig(radius);
        rig.add(shared::groove(angle, 20.0), {}, rough(0.5, 0.5));
        const double height = radius / std::sin(0.5 * angle);
        rig.draw({0.0, height + 0.01, 0.0}, {0.0, height - 0.02, 0.0}, 20);
        ASSERT_EQ(rig.proxy.touching().size(), 2u);
        for (const Touch& contact : rig.proxy.touching()) {
            EXPECT_NEAR(contact.pressure, 0.02 / (2.0 * std::sin(0.5 * angle)), 1e-6);
        }
    }
}

TEST(ProxyFriction, SticksBelowTheStaticLimitWithoutADrift) {
    TouchRig rig(radius);
    rig.add(shared::groove(std::numbers::pi, 20.0), {}, rough(0.5, 0.3));
    rig.draw({0.0, 0.1, 0.0}, {0.0, radius - 0.02, 0.0}, 10);
    const Vec3 stuck = rig.proxy.position();
    for (int i = 0; i < 10'000; ++i) {
        const double pull = 0.0099 * std::sin(0.01 * i);  // the limit is 0.5 * 0.02
        const ProxyTick tick = rig.tick({0.0, radius - 0.02, pull});
        ASSERT_EQ(tick.position.z, stuck.z) << "tick " << i;
        ASSERT_EQ(tick.status & proxy_sliding, 0u);
    }
}

TEST(ProxyFriction, GivesWayAtTheStaticLimitAndThenHoldsByTheDynamicOne) {
    TouchRig rig(radius);
    rig.add(shared::groove(std::numbers::pi, 20.0), {}, rough(0.5, 0.3));
    rig.draw({0.0, 0.1, 0.0}, {0.0, radius - 0.02, 0.0}, 10);
    const double start = rig.proxy.position().z;
    EXPECT_EQ(rig.tick({0.0, radius - 0.02, 0.00999}).position.z, start);
    const ProxyTick slipped = rig.tick({0.0, radius - 0.02, 0.0101});
    EXPECT_TRUE(slipped.status & proxy_sliding);
    EXPECT_NEAR(0.0101 - slipped.position.z, 0.3 * 0.02, 1e-6);
}

TEST(ProxyFriction, AfterSlidingASmallPullSticksAgain) {
    TouchRig rig(radius);
    rig.add(shared::groove(std::numbers::pi, 20.0), {}, rough(0.5, 0.3));
    rig.draw({0.0, 0.1, 0.0}, {0.0, radius - 0.02, 0.0}, 10);
    rig.draw({0.0, radius - 0.02, 0.0}, {0.0, radius - 0.02, 0.5}, 100);
    const Vec3 hand(0.0, radius - 0.02, 0.5);
    const double left = rig.tick(hand).position.z;
    const ProxyTick held = rig.tick({0.0, radius - 0.02, 0.502});  // 0.006 + 0.002 is below 0.5 * 0.02
    EXPECT_EQ(held.position.z, left);
    EXPECT_EQ(held.status & proxy_sliding, 0u);
}

// A surface that is put right under a sliding proxy, a little each tick and towards the hand, as a camera's
// noise does it.
TEST(ProxyFriction, ASurfaceThatIsPutElsewhereDoesNotEndASlide) {
    TouchRig rig(radius);
    const int floor = rig.add(shared::groove(std::numbers::pi, 20.0), {}, rough(0.5, 0.3));
    rig.draw({0.0, 0.1, 0.0}, {0.0, radius - 0.02, 0.0}, 10);
    Vec3 hand(0.0, radius - 0.02, 0.0);
    rig.draw(hand, {0.0, hand.y, 0.5}, 500);
    hand.z = 0.5;
    Pose pose;
    for (int i = 0; i < 200; ++i) {
        const Vec3 put(0.0, i % 2 == 0 ? 1e-4 : -1e-4, 2e-3);
        rig.proxy.go_along(put, floor);
        pose.position += put;
        rig.scene.set_pose(floor, pose, true);
        hand.z += 1e-3;
        const ProxyTick tick = rig.tick(hand);
        ASSERT_TRUE(tick.status & proxy_sliding) << i;
        ASSERT_NEAR(hand.z - tick.position.z, 0.3 * (tick.position.y - hand.y), 1e-6) << i;
    }
}

TEST(ProxyFriction, AProxyThatSticksGoesAlongWithItsSurface) {
    TouchRig rig(radius);
    const int floor = rig.add(shared::groove(std::numbers::pi, 20.0), {}, rough(0.5, 0.3));
    rig.draw({0.0, 0.1, 0.0}, {0.0, radius - 0.02, 0.0}, 10);
    const Vec3 before = rig.proxy.position();
    rig.proxy.go_along({0.0, 1e-4, 2e-3}, floor);
    EXPECT_EQ(rig.proxy.position(), before + Vec3(0.0, 1e-4, 2e-3));
}

TEST(ProxyFriction, IsTheSameInEveryDirectionOfThePlane) {
    for (int k = 0; k < 12; ++k) {
        const double a = 2.0 * std::numbers::pi * k / 12.0;
        const Vec3 along(std::cos(a), 0.0, std::sin(a));
        TouchRig rig(radius);
        rig.add(PlaneShape{}, {}, rough(0.4, 0.4));
        const Vec3 start(0.0, radius - 0.02, 0.0);
        rig.draw({0.0, 0.2, 0.0}, start, 10);
        const Vec3 hand = start + along;
        const Vec3 back = hand - rig.draw(start, hand, 1'000).position;
        EXPECT_NEAR(glm::dot(back, along), 0.4 * 0.02, 5e-3 * 0.4 * 0.02);
        EXPECT_NEAR(glm::length(glm::cross(back, along) -
                                glm::dot(glm::cross(back, along), Vec3(0, 1, 0)) * Vec3(0, 1, 0)),
                    std::abs(back.y), 1e-6);
    }
}

TEST(ProxyFriction, WithoutFrictionNothingHolds) {
    TouchRig rig(radius);
    rig.add(PlaneShape{}, {}, rough(0.0, 0.0));
    const Vec3 start(0.0, radius - 0.02, 0.0);
    rig.draw({0.0, 0.2, 0.0}, start, 10);
    const Vec3 hand = start + Vec3(1.0, 0.0, 0.0);
    EXPECT_NEAR(rig.draw(start, hand, 1'000).position.x, hand.x, 1e-12);
}

TEST(ProxyFriction, EachBodyHoldsByItsOwnCoefficient) {
    TouchRig rig(radius);
    rig.add(PlaneShape{Vec3(0.0, 1.0, 0.0), 0.0}, {}, rough(0.2, 0.2));
    rig.add(PlaneShape{Vec3(1.0, 0.0, 0.0), 0.0}, {}, rough(0.6, 0.6));
    const Vec3 start(radius - 0.01, radius - 0.02, 0.0);
    rig.draw({0.2, 0.2, 0.0}, start, 10);
    const Vec3 hand = start + Vec3(0.0, 0.0, 1.0);
    const double back = hand.z - rig.draw(start, hand, 1'000).position.z;
    EXPECT_NEAR(back, 0.2 * 0.02 + 0.6 * 0.01, 5e-3 * 0.01);
}

// Every facet ends at an edge, and beyond it the next one lies lower than a straight step leads. The pull is
// held there as anywhere else.
TEST(ProxyFriction, HoldsAllTheWayAroundAFacetedBall) {
    constexpr double friction = 0.3;
    TouchRig rig(radius);
    rig.add(shared::icosphere(3, 0.4), {}, TouchMaterial{1.0, 0.0, friction, friction});
    const auto hand = [](double angle, double depth) {
        return (0.4 + radius - depth) * Vec3(std::cos(angle), std::sin(angle), 0.31 * std::cos(angle));
    };
    rig.draw(hand(0.0, -0.1), hand(0.0, 0.03), 100);
    int ticks = 0;
    for (double angle = 0.0; angle < 2.0; angle += 0.002) {
        const ProxyTick tick = rig.tick(hand(angle, 0.03));
        if (angle < 0.1) {
            continue;  // until static friction has given way
        }
        double pressure = 0.0;
        for (const Touch& contact : rig.proxy.touching()) {
            pressure += contact.pressure;
        }
        ASSERT_NEAR(glm::length(tick.slide) / pressure, friction, 0.005 * friction) << "angle " << angle;
        ++ticks;
    }
    EXPECT_GT(ticks, 900);
}

}  // namespace
}  // namespace tactus::proxy_friction_test
