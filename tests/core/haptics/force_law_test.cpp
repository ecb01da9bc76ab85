#include "core/haptics/force_law.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::force_law_test {
namespace {

using shared::TouchRig;

TouchMaterial stiff(double stiffness, double damping = 0.0) {
    return {stiffness, damping, 0.0, 0.0};
}

// A hand pressed into a plane, the proxy resting on it.
struct Pressed {
    explicit Pressed(const TouchMaterial& material) : rig(0.05) {
        plane = rig.add(PlaneShape{}, {}, material);
        rig.draw({0.0, 0.1, 0.0}, hand, 10);
    }
    HandForce force(const Vec3& velocity = Vec3(0.0)) {
        const ProxyTick tick = rig.tick(hand);
        return contact_force(rig.scene, rig.proxy.touching(), tick.slide, velocity, 1e-3);
    }
    TouchRig rig;
    int plane = -1;
    Vec3 hand{0.0, 0.03, 0.0};
};

TEST(ForceLaw, SpringPushesTheHandTowardsTheProxy) {
    Pressed pressed(stiff(800.0));
    const HandForce force = pressed.force();
    const Vec3 expected = 800.0 * (pressed.rig.proxy.position() - pressed.hand);  // eq. 3.2
    EXPECT_LT(glm::length(force.total - expected), 1e-9);
    EXPECT_GT(force.total.y, 0.0);
}

TEST(ForceLaw, DampingActsOnTheApproachOnly) {
    Pressed pressed(stiff(800.0, 3.0));
    const double at_rest = pressed.force().total.y;
    EXPECT_NEAR(pressed.force({0.0, -0.2, 0.0}).total.y, at_rest + 3.0 * 0.2, 1e-9);
    EXPECT_NEAR(pressed.force({0.0, 0.2, 0.0}).total.y, at_rest - 3.0 * 0.2, 1e-9);
    EXPECT_NEAR(pressed.force({0.7, 0.0, 0.4}).total.y, at_rest, 1e-9);
}

// Two springs in series, one of them with a damper: held against their steady compression at a slow speed.
TEST(ForceLaw, APadGivesWayWithTheSurface) {
    const double surface = 800.0, damping = 3.0, pad = 400.0, seconds = 1e-6, speed = 0.01;
    double given = 0.0;  // by the surface
    double pressed = 0.0;
    double force = 0.0;
    for (int i = 0; i < 200'000; ++i) {
        pressed += speed * seconds;
        const double rate = (pad * (pressed - given) - surface * given) / damping;
        given += rate * seconds;
        force = pad * (pressed - given);
    }
    const Wall wall = under_pad({surface, damping}, pad);
    EXPECT_NEAR(wall.stiffness * pressed + wall.damping * speed, force, 1e-5);
    EXPECT_EQ(under_pad({surface, damping}, 0.0).stiffness, surface);
    EXPECT_EQ(under_pad({0.0, damping}, pad).damping, damping);
}

TEST(ForceLaw, DampingNeverPullsTheHandIn) {
    Pressed pressed(stiff(10.0, 100.0));
    EXPECT_EQ(pressed.force({0.0, 50.0, 0.0}).total.y, 0.0);
}

TEST(ForceLaw, DampingCountsTheSpeedRelativeToTheBody) {
    TouchRig rig(0.05);
    const int floor = rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)}, {}, stiff(800.0, 3.0));
    const Vec3 hand(0.0, 0.13, 0.0);
    rig.draw({0.0, 0.3, 0.0}, hand, 10);
    const double still =
        contact_force(rig.scene, rig.proxy.touching(), rig.tick(hand).slide, Vec3(0.0), 1e-3).total.y;
    // The box rises with the hand: no approach between the two.
    const Vec3 rise(0.0, 1e-4, 0.0);
    const ProxyTick tick = rig.tick(hand + rise, floor, {rise, Quat(1.0, 0.0, 0.0, 0.0)});
    const HandForce force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, rise / 1e-3, 1e-3);
    EXPECT_NEAR(force.total.y, still, 1e-6);
}

TEST(ForceLaw, SeveralBodiesPressWithTheirOwnStiffness) {
    TouchRig rig(0.05);
    const int soft = rig.add(PlaneShape{Vec3(0.0, 1.0, 0.0), 0.0}, {}, stiff(100.0));
    const int hard = rig.add(PlaneShape{Vec3(1.0, 0.0, 0.0), 0.0}, {}, stiff(1000.0));
    const Vec3 hand(0.03, 0.03, 0.0);
    const ProxyTick tick = rig.draw({0.2, 0.2, 0.0}, hand, 10);
    const HandForce force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3);
    ASSERT_EQ(force.contact_count, 2);
    EXPECT_NEAR(force.total.y, 100.0 * 0.02, 1e-5);
    EXPECT_NEAR(force.total.x, 1000.0 * 0.02, 1e-4);
    for (int i = 0; i < 2; ++i) {
        const bool is_soft = force.contacts[i].body == soft;
        EXPECT_TRUE(is_soft || force.contacts[i].body == hard);
        EXPECT_NEAR(glm::length(force.contacts[i].on_hand), is_soft ? 2.0 : 20.0, 1e-4);
    }
}

Vec3 sum_over_bodies(const HandForce& force) {
    Vec3 sum(0.0);
    for (int i = 0; i < force.contact_count; ++i) {
        sum += force.contacts[i].on_hand;
    }
    return sum;
}

TEST(ForceLaw, BodiesTogetherFeelTheOppositeOfTheHand) {
    shared::RandomValues random(91);
    TouchRig rig(0.05);
    TouchMaterial material = stiff(500.0, 2.0);
    material.static_friction = material.dynamic_friction = 0.4;
    rig.add(shared::terrain(16, 1.0, 0.05), {}, material);
    rig.add(PlaneShape{Vec3(1.0, 0.0, 0.0), -0.3}, {}, stiff(200.0));
    Vec3 hand(0.0, 0.3, 0.0);
    Vec3 before(0.0);
    int touched = 0;
    for (int i = 0; i < 2'000; ++i) {
        const Vec3 goal(0.35 * std::sin(0.01 * i), -0.05, 0.3 * std::cos(0.013 * i));
        const Vec3 velocity = (goal - hand) * 10.0;
        hand += (goal - hand) * 0.02;
        const ProxyTick tick = rig.tick(hand);
        HandForce force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, velocity, 1e-3);
        ASSERT_LT(glm::length(sum_over_bodies(force) - force.total),
                  1e-12 * (1.0 + glm::length(force.total)));
        smooth(force, before);
        if (force.contact_count > 0) {
            ++touched;
            ASSERT_LT(glm::length(sum_over_bodies(force) - force.total),
                      1e-12 * (1.0 + glm::length(force.total)));
        }
        before = force.total;
    }
    EXPECT_GT(touched, 1'000);
}

TEST(ForceLaw, SmoothedIsTheMeanOfBeforeAndNow) {
    Pressed pressed(stiff(800.0));
    HandForce force = pressed.force();
    const Vec3 now = force.total;
    const Vec3 before(1.0, 2.0, 3.0);
    smooth(force, before);
    EXPECT_LT(glm::length(force.total - 0.5 * (now + before)), 1e-12);  // eq. 3.3
}

TEST(ForceLaw, SmoothedFadesAfterContact) {
    HandForce nothing;
    smooth(nothing, {0.0, 8.0, 0.0});
    EXPECT_EQ(nothing.total, Vec3(0.0, 4.0, 0.0));
}

}  // namespace
}  // namespace tactus::force_law_test
