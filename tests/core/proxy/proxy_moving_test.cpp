// Bodies that move under, into and around the proxy.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "core/proxy/proxy.hpp"
#include "shared/meshes.hpp"
#include "shared/poses.hpp"
#include "shared/random_values.hpp"
#include "shared/slow_distance.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_moving_test {
namespace {

using shared::at;
using shared::RandomValues;
using shared::TouchRig;

constexpr double radius = 0.05;
const TouchMaterial sticky{500.0, 0.0, 2.0, 2.0};

Quat turn(double angle, const Vec3& axis) {
    const Vec3 v = std::sin(0.5 * angle) * axis;
    return {std::cos(0.5 * angle), v.x, v.y, v.z};
}

TEST(ProxyMoving, ABodyItSticksToCarriesIt) {
    TouchRig rig(radius);
    const int table = rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)}, {}, sticky);
    const Vec3 hand(0.0, 0.12, 0.0);
    rig.draw({0.0, 0.4, 0.0}, hand, 10);
    for (int i = 1; i <= 20; ++i) {
        const ProxyTick tick = rig.tick(hand, table, at({0.0005 * i, 0.0, 0.0}));
        ASSERT_NEAR(tick.position.x, 0.0005 * i, 1e-9) << i;
        ASSERT_NEAR(tick.position.y, 0.15, 1e-8) << i;
    }
}

TEST(ProxyMoving, ATurningBodyCarriesItAround) {
    TouchRig rig(radius);
    const int table = rig.add(CylinderShape{1.0, 0.1}, {}, sticky);
    const Vec3 start(0.5, 0.12, 0.0);
    rig.draw({0.5, 0.4, 0.0}, start, 10);
    for (int i = 1; i <= 200; ++i) {
        const double a = 0.01 * i;
        const Quat q = turn(a, {0.0, 1.0, 0.0});
        const Vec3 hand = q * start;  // the hand goes along: nothing pulls it off
        const ProxyTick tick = rig.tick(hand, table, {Vec3(0.0), q});
        ASSERT_LT(glm::length(tick.position - q * Vec3(0.5, 0.15, 0.0)), 1e-7) << i;
    }
}

// A finger in a corner of a floor and a wall, each of them sticky, goes with what it presses harder.
TEST(ProxyMoving, OfTwoBodiesItSticksToTheOneThatItPressesHarder) {
    for (const bool leans_on_wall : {false, true}) {
        TouchRig rig(radius);
        rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)}, {}, sticky);
        const int wall = rig.add(BoxShape{Vec3(0.1, 0.5, 1.0)}, at({0.3, 0.6, 0.0}), sticky);
        const Vec3 hand =
            Vec3(0.15, 0.15, 0.0) + (leans_on_wall ? Vec3(0.03, -0.005, 0.0) : Vec3(0.005, -0.03, 0.0));
        rig.draw({0.1, 0.4, 0.0}, hand, 20);
        rig.tick(hand);
        double along = 0.0;
        for (int i = 1; i <= 20; ++i) {
            along = rig.tick(hand, wall, at({0.3, 0.6, 0.0001 * i})).position.z;
        }
        EXPECT_NEAR(along, leans_on_wall ? 0.002 : 0.0, 1e-6);
        rig.proxy.set_sliding(false);
        rig.proxy.go_along({0.0, 0.0, 0.002}, wall);
        EXPECT_NEAR(rig.proxy.position().z - along, leans_on_wall ? 0.002 : 0.0, 1e-9);
    }
}

// A finger does not turn. On a drum of radius R that turns by a it goes as far as the drum's material does,
// R a, and so by the angle R a / (R + r) about the axis; as part of the drum it would go by a.
TEST(ProxyMoving, OnATurningDrumItRollsBack) {
    constexpr double drum_radius = 0.2;
    for (const double step : {1e-4, 1e-3, 0.01}) {
        TouchRig rig(radius);
        const int drum = rig.add(SphereShape{drum_radius}, {}, sticky);
        const double reach = drum_radius + radius;
        rig.draw({0.0, 0.6, 0.0}, {0.0, reach - 0.01, 0.0}, 10);
        double gone = 0.0;
        for (double a = step; a < 0.5; a += step) {
            gone += step * drum_radius / reach;
            const Vec3 hand = (reach - 0.01) * Vec3(std::sin(gone), std::cos(gone), 0.0);
            const ProxyTick tick = rig.tick(hand, drum, {Vec3(0.0), turn(-a, {0.0, 0.0, 1.0})});
            ASSERT_NEAR(std::atan2(tick.position.x, tick.position.y), gone, 2e-3 * gone + 1e-6) << step;
            ASSERT_GE(glm::length(tick.position), reach) << step;
        }
    }
}

TEST(ProxyMoving, WithoutFrictionABodySlidesAwayUnderneath) {
    TouchRig rig(radius);
    const int table = rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)});
    const Vec3 hand(0.0, 0.12, 0.0);
    rig.draw({0.0, 0.4, 0.0}, hand, 10);
    for (int i = 1; i <= 100; ++i) {
        const ProxyTick tick = rig.tick(hand, table, at({0.001 * i, 0.0, 0.0}));
        ASSERT_NEAR(tick.position.x, 0.0, 1e-9) << i;
    }
}

class ProxyPushed : public ::testing::TestWithParam<bool> {
protected:
    int add_box(TouchRig& rig, const Vec3& half, const Pose& pose) {
        return GetParam() ? rig.add(shared::box(half), pose) : rig.add(BoxShape{half}, pose);
    }
};

TEST_P(ProxyPushed, ABodyThatRisesLiftsTheProxy) {
    TouchRig rig(radius);
    const int table = add_box(rig, Vec3(1.0, 0.1, 1.0), at({0.0, -0.5, 0.0}));
    const Vec3 hand(0.1, 0.0, 0.2);
    rig.tick(hand);
    for (int i = 1; i <= 400; ++i) {
        const double top = -0.4 + 0.002 * i;
        const ProxyTick tick = rig.tick(hand, table, at({0.0, top - 0.1, 0.0}));
        ASSERT_GE(tick.position.y, top + radius) << i;
        ASSERT_NEAR(tick.position.y, std::max(0.0, top + radius), 1e-7) << i;
        ASSERT_EQ(tick.status & proxy_squeezed, 0u);
    }
}

TEST_P(ProxyPushed, ATurningPaddlePushesItAhead) {
    TouchRig rig(radius);
    const int paddle = add_box(rig, Vec3(1.0, 0.5, 0.01), at({0.0, 0.0, 0.0}));
    const Vec3 hand(0.6, 0.0, 0.3);
    rig.tick(hand);
    double before = 1.0;
    for (int i = 1; i <= 300; ++i) {
        const Quat q = turn(-0.003 * i, {0.0, 1.0, 0.0});  // towards +z at x > 0
        const ProxyTick tick = rig.tick(hand, paddle, {Vec3(0.0), q});
        const Vec3 seen = glm::conjugate(q) * tick.position;
        ASSERT_GE(seen.z, 0.01 + radius - 1e-9) << i;
        before = seen.z;
    }
    EXPECT_LT(before, 0.1);  // it did get pushed
}

TEST_P(ProxyPushed, AStaticWallBehindHoldsAndTheSqueezeIsReported) {
    TouchRig rig(radius);
    const int press = add_box(rig, Vec3(1.0, 0.1, 1.0), at({0.0, -0.5, 0.0}));
    add_box(rig, Vec3(1.0, 0.1, 1.0), at({0.0, 0.5, 0.0}));
    const Vec3 hand(0.0, 0.0, 0.0);
    rig.tick(hand);
    bool squeezed = false;
    for (int i = 1; i <= 1'000; ++i) {  // leaves less than its diameter in the end
        const double top = std::min(-0.4 + 0.001 * i, 0.31);
        const ProxyTick tick = rig.tick(hand, press, at({0.0, top - 0.1, 0.0}));
        ASSERT_LE(tick.position.y, 0.4 - radius) << i;  // what stands still is never entered
        if (top < 0.4 - 2.0 * radius - 1e-6) {
            ASSERT_GE(tick.position.y, top + radius - 1e-9) << i;
        } else {
            squeezed = squeezed || (tick.status & proxy_squeezed);
        }
    }
    EXPECT_TRUE(squeezed);
}

TEST_P(ProxyPushed, AFastThinPlateTakesItAlongAndDoesNotPass) {
    TouchRig rig(radius);
    const int plate = add_box(rig, Vec3(1.0, 0.001, 1.0), at({0.0, -1.0, 0.0}));
    const Vec3 hand(0.1, 0.0, 0.2);
    rig.tick(hand);
    for (int i = 1; i <= 40; ++i) {  // 60 m/s
        const double y = -1.0 + 0.06 * i;
        const ProxyTick tick = rig.tick(hand, plate, at({0.0, y, 0.0}));
        ASSERT_GE(tick.position.y, std::max(0.0, y + 0.001 + radius) - 1e-9) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(ClosedFormAndTriangles, ProxyPushed, ::testing::Bool());

TEST(ProxyMoving, TwoBodiesClosingOnItBothPushUntilThereIsNoRoom) {
    TouchRig rig(radius);
    const int low = rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)}, at({0.0, -0.5, 0.0}));
    const int high = rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)}, at({0.0, 0.5, 0.0}));
    const Vec3 hand(0.0, 0.2, 0.0);
    rig.tick(hand);
    for (int i = 1; i <= 340; ++i) {
        const double half_gap = 0.4 - 0.001 * i;
        rig.scene.begin_tick();
        rig.scene.set_pose(low, at({0.0, -half_gap - 0.1, 0.0}));
        rig.scene.set_pose(high, at({0.0, half_gap + 0.1, 0.0}));
        const ProxyTick tick = rig.proxy.move(rig.scene, hand);
        ASSERT_GE(tick.position.y, -half_gap + radius - 1e-9) << i;
        ASSERT_LE(tick.position.y, half_gap - radius + 1e-9) << i;
    }
}

// Random tumbling boxes around a random hand: while it is not squeezed the proxy is outside all of them.
TEST(ProxyMoving, TumblingBodiesNeverEndUpAroundTheProxy) {
    RandomValues random(121);
    int touched = 0;
    for (int run = 0; run < 20; ++run) {
        TouchRig rig(0.03);
        const Vec3 half(0.2, 0.1, 0.3);
        const TriangleMesh mesh = shared::box(half);
        const int body = run % 2 ? rig.add(mesh) : rig.add(BoxShape{half});
        Vec3 hand(0.6, 0.0, 0.0);
        rig.tick(hand);
        Vec3 place(0.0);
        Quat q(1.0, 0.0, 0.0, 0.0);
        Vec3 velocity = random.in_ball(0.004);
        Vec3 spin = random.direction();
        double rate = random.between(0.0, 0.02);
        for (int i = 0; i < 2'000; ++i) {
            if (i % 100 == 0) {
                velocity = random.in_ball(0.004) - 0.003 * place;
                spin = random.direction();
                rate = random.between(0.0, 0.02);
            }
            place += velocity;
            q = glm::normalize(turn(rate, spin) * q);
            hand = glm::clamp(hand + random.in_ball(0.01), Vec3(-0.5), Vec3(0.5));
            const ProxyTick tick = rig.tick(hand, body, {place, q});
            const Vec3 seen = glm::conjugate(q) * (tick.position - place);
            touched += (tick.status & proxy_touching) != 0;
            ASSERT_GE(static_cast<double>(shared::slow_distance(seen, mesh)), 0.03 - 1e-9)
                << "run " << run << ", tick " << i;
            ASSERT_FALSE(glm::all(glm::lessThan(glm::abs(seen), half))) << "run " << run << ", tick " << i;
        }
    }
    EXPECT_GT(touched, 1'000);
}

TEST(ProxyMoving, ATeleportPushesNothing) {
    TouchRig rig(radius);
    const int body = rig.add(BoxShape{Vec3(0.1)}, at({-1.0, 0.0, 0.0}));
    const Vec3 hand(0.0, 0.0, 0.0);
    rig.tick(hand);
    rig.scene.begin_tick();
    rig.scene.set_pose(body, at({1.0, 0.0, 0.0}), true);  // straight through the proxy
    EXPECT_EQ(rig.proxy.move(rig.scene, hand).position, hand);
    EXPECT_NEAR(rig.draw(hand, {1.0, 0.0, 0.0}, 50).position.x, 0.9 - radius, 1e-8);
}

TEST(ProxyMoving, AddedAndRemovedBodiesAreSeenAtOnce) {
    TouchRig rig(radius);
    const int first = rig.add(BoxShape{Vec3(0.5)}, at({0.0, -0.6, 0.0}));
    rig.draw({0.0, 0.2, 0.0}, {0.0, -0.1, 0.0}, 20);
    EXPECT_NEAR(rig.proxy.position().y, -0.05, 1e-8);
    rig.scene.remove(first);
    EXPECT_EQ(rig.tick({0.0, -0.1, 0.0}).position.y, -0.1);
    rig.add(BoxShape{Vec3(0.5)}, at({0.0, -0.9, 0.0}));
    EXPECT_NEAR(rig.draw({0.0, -0.1, 0.0}, {0.0, -0.6, 0.0}, 20).position.y, -0.35, 1e-8);
}

// A proxy that was never in this scene takes the place of one that was, as a replay does.
TEST(ProxyMoving, AnotherProxyGoesOnFromWhatOneRemembers) {
    TouchRig rig(radius);
    const int table = rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)});
    const Vec3 hand(0.0, 0.12, 0.0);
    rig.draw({0.0, 0.4, 0.0}, hand, 10);
    Proxy other(64, rig.proxy.settings());
    other.recall(rig.proxy.memory());
    rig.scene.begin_tick();
    rig.scene.set_pose(table, at({0.0, 0.001, 0.0}));
    const ProxyTick tick = other.move(rig.scene, hand);
    EXPECT_NEAR(tick.position.y, 0.151, 1e-8);
    EXPECT_FALSE(tick.status & proxy_letting_out);
}

}  // namespace
}  // namespace tactus::proxy_moving_test
