#include "core/teleop/passive_update.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/teleop/errors.hpp"
#include "shared/random_values.hpp"

namespace tactus::passive_update_test {
namespace {

constexpr double tick = 1e-3;
constexpr double stiffness = 500.0;

// A level wall of which the model believes that it is at `height`. Its friction holds the fingertip: the hand
// drags it behind on the same spring.
struct Wall {
    double height = 0.0;
    double friction = 0.0;

    Vec3 force(const Vec3& hand, const Vec3& tip) const {
        const double pressed = std::max(0.0, height - hand.y) * stiffness;
        const double most = friction * pressed;
        return {std::clamp(stiffness * (tip.x - hand.x), -most, most), pressed, 0.0};
    }
};

// A hand that goes where it likes on a wall that is corrected under it.
struct Touch {
    Wall wall;
    PassiveUpdate update;
    PassiveUpdateSettings settings;
    PortEnergy port;
    Vec3 hand{0.0}, tip{0.0}, felt{0.0};
    double leak = 0.0;  // of a force that is held for a tick (unit: joules)

    // To `place`; at the end of the tick's way the wall is found at `height`.
    void go(const Vec3& place, double height) {
        const Vec3 way = place - hand;
        port.add(felt, way);
        const Vec3 held = felt;
        hand = place;
        const Vec3 before = wall.force(hand, tip);
        const bool corrected = height != wall.height;
        wall.height = height;
        const Vec3 modelled = wall.force(hand, tip);
        tip = {hand.x + modelled.x / stiffness, 0.0, 0.0};
        if (corrected) {
            update.changed(before, stiffness, modelled, stiffness);
        }
        FeltInput in;
        in.modelled = modelled;
        in.hand_velocity = way / tick;
        in.stiffness = modelled.y > 0.0 ? stiffness : 0.0;
        in.seconds = tick;
        felt = update.feel(settings, in);
        leak += glm::distance(felt, held) * glm::length(way);
    }
    void go_on(int ticks, const Vec3& way) {
        for (int i = 0; i < ticks; ++i) {
            go(hand + way, wall.height);
        }
    }
};

TEST(PassiveUpdate, AModelThatStaysIsFeltAsItIs) {
    Touch touch;
    touch.wall.friction = 0.3;
    for (int i = 0; i < 400; ++i) {
        const Vec3 place(1e-4 * i, -1e-3 * std::sin(0.02 * i), 0.0);
        const Vec3 expected = touch.wall.force(place, touch.tip);
        touch.go(place, 0.0);
        ASSERT_EQ(touch.felt, expected) << i;
    }
}

TEST(PassiveUpdate, TheForceOfAPressingHandGoesOnWithoutAStep) {
    for (const double height : {-0.002, 0.001, 0.004, 0.02}) {
        Touch touch;
        touch.go_on(500, {0.0, -1e-5, 0.0});  // 5 mm deep
        const double before = touch.felt.y;
        touch.go(touch.hand, height);
        EXPECT_NEAR(touch.felt.y, before, 0.07) << height;  // a tick of what is brought in or taken out
    }
}

TEST(PassiveUpdate, WithoutFrictionTheHandGetsBackWhatItHasPutInAndNoMore) {
    Touch touch;
    touch.go_on(500, {0.0, -1e-5, 0.0});
    touch.go(touch.hand, 0.01);
    touch.go_on(2000, Vec3(0.0));
    EXPECT_LT(touch.felt.y, 7.5);  // which the model says
    EXPECT_GT(touch.felt.y, 2.5);
    touch.go_on(2000, {0.0, 1e-5, 0.0});  // out
    EXPECT_EQ(touch.felt, Vec3(0.0));
    EXPECT_LE(touch.port.created(), touch.leak);
    EXPECT_NEAR(touch.port.total(), 0.0, touch.leak);
}

TEST(PassiveUpdate, FrictionPaysForTheTruth) {
    Touch touch;
    touch.wall.friction = 0.4;
    touch.go_on(500, {0.0, -1e-5, 0.0});
    touch.go(touch.hand, 0.001);
    EXPECT_NEAR(touch.felt.y, 2.5, 0.02);
    touch.go_on(1000, {1e-4, 0.0, 0.0});  // 1 N for 0.1 m
    EXPECT_NEAR(touch.felt.y, 3.0, 1e-6);
    EXPECT_EQ(touch.update.unpaid(), 0.0);
}

TEST(PassiveUpdate, WhatIsNoMoreGoesWithinItsTime) {
    Touch touch;
    touch.go_on(500, {0.0, -1e-5, 0.0});
    touch.go(touch.hand, -0.002);
    touch.go_on(350, Vec3(0.0));
    EXPECT_NEAR(touch.felt.y, 1.5, 1e-9);
    EXPECT_GT(touch.update.tank(), 0.0);
}

TEST(PassiveUpdate, NoWayOfAHandGetsMoreThanItHasPutIn) {
    shared::RandomValues random(5);
    for (int run = 0; run < 50; ++run) {
        Touch touch;
        touch.wall.friction = run % 2 == 0 ? 0.0 : 0.3;
        Vec3 way(0.0, -2e-5, 0.0);
        for (int i = 0; i < 3000; ++i) {
            if (random.below(50) == 0) {
                way = Vec3(random.between(-1e-5, 1e-5), random.between(-4e-5, 4e-5), 0.0);
            }
            const double height = random.below(40) == 0 ? random.between(-0.005, 0.02) : touch.wall.height;
            touch.go(touch.hand + way, height);
            ASSERT_LE(touch.port.created(), touch.leak) << run << " " << i;
        }
    }
}

TEST(PassiveUpdate, WhatACorrectionGaveABodyInSpeedIsDamped) {
    Touch touch;
    touch.go_on(500, {0.0, -1e-5, 0.0});
    touch.update.sped_up(0.001);
    const double before = touch.port.total();
    touch.go_on(30, {0.0, 1e-5, 0.0});
    // The first of what the spring gives is owed; only the force held from before is felt for a tick.
    EXPECT_NEAR(touch.port.total(), before, 2.6e-5);
    touch.go_on(500, {0.0, 1e-5, 0.0});
    EXPECT_NEAR(touch.update.damped(), 0.001, 1e-9);
    EXPECT_NEAR(touch.port.total(), -0.001, touch.leak);
}

}  // namespace
}  // namespace tactus::passive_update_test
