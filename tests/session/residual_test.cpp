// What acts on a far body besides the operator, and is not described, is felt: another hand, a spring, a wall.
#include <algorithm>
#include <cmath>

#include "linked_tools.hpp"

namespace tactus {
namespace {

using namespace session_test;

struct Held {
    double felt = 0.0, far = 0.0;    // at the end (unit: newtons)
    double apart = 0.0;              // the boxes (unit: meters)
};

// A box of 0.3 kg on a floor, held in its place by a script's spring at the far side only, is pressed from the
// side, 15 mm beyond its surface.
Held press_against_a_spring(double delay, double spring, const TeleopSettings& settings = {}) {
    LinkedPlaces places(delay, 0.0, 1, settings, settings);
    BodyAddition floor = ground();
    floor.description.material.friction = 0.2;
    places.add(floor);
    BodyAddition box = body(BoxShape{Vec3(0.025)}, {0.0, 0.025, 0.0}, Motion::Dynamic, 0.3);
    box.description.material.friction = 0.2;
    const SessionHandle held = places.add(box);
    places.settle();
    HeldDevice& hand = places.near.devices[0];
    hand.position = {0.08, 0.025, 0.0};
    Vec3 before = places.far.pose(held).position;
    const auto ticks = [&](int count) {
        for (int i = 0; i < count; ++i) {
            const Vec3 at = places.far.pose(held).position;
            const Vec3 velocity = (at - before) / 1e-3;
            before = at;
            const double pull = -spring * at.x - 5.0 * velocity.x;
            places.far.session.set_body_push(held, {pull, 0.0, 0.0}, Vec3(0.0));
            places.tick();
        }
    };
    ticks(500);
    for (int i = 1; i <= 300; ++i) {
        hand.position.x = 0.08 - 0.06 * i / 300.0;
        ticks(1);
    }
    ticks(1000);
    Held result;
    result.felt = glm::length(hand.force);
    result.far = glm::length(places.far.session.snapshot().proxies[0].force);
    result.apart = places.apart(1);
    return result;
}

TEST(Residual, WhatHoldsTheFarBodyIsFelt) {
    for (const double delay : {0.0, 0.01, 0.05, 0.2}) {
        const Held held = press_against_a_spring(delay, 1000.0);
        EXPECT_GT(held.far, 3.0) << delay;
        EXPECT_NEAR(held.felt, held.far, 0.1 * held.far) << delay;
        EXPECT_LT(held.apart, 2e-3) << delay;
    }
}

TEST(Residual, AStiffWallThatIsNotDescribedIsFelt) {
    const Held held = press_against_a_spring(0.05, 5000.0);
    EXPECT_NEAR(held.felt, held.far, 0.1 * held.far);
}

TEST(Residual, WhereNothingElseActsThereIsNone) {
    const Held held = press_against_a_spring(0.05, 0.0);
    TeleopSettings without;
    without.residual.gain = 0.0;
    const Held as_before = press_against_a_spring(0.05, 0.0, without);
    EXPECT_NEAR(held.felt, as_before.felt, 0.05);
    EXPECT_LT(held.apart, 1e-3);
}

}  // namespace
}  // namespace tactus
