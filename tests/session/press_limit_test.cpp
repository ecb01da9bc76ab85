// How deep a far hand may press while its samples are guessed.
#include "session/press_limit.hpp"

#include <gtest/gtest.h>

namespace tactus::press_limit_test {
namespace {

using Hand = PressLimit::Hand;

PressLimit::In in(Hand hand) {
    PressLimit::In made;
    made.hand = hand;
    made.own_force = 1.0;
    return made;
}

// A hand that is here, `depth` deep (unit: meters).
void is_here(PressLimit& limit, double depth) {
    if (limit.binds(Hand::here)) {
        limit.step(in(Hand::here));
        limit.applied(Hand::here, depth);
    }
    if (!limit.binds(Hand::here)) {
        limit.note(depth);
    }
}

void is_guessed(PressLimit& limit, double depth, int ticks) {
    for (int i = 0; i < ticks; ++i) {
        limit.step(in(Hand::guessed));
        limit.applied(Hand::guessed, depth);
    }
}

PressLimit pressing(double depth) {
    PressLimit limit;
    for (int i = 0; i < 100; ++i) {
        is_here(limit, depth);
    }
    return limit;
}

TEST(PressLimit, AGuessThatLastsPressesHardlyMore) {
    PressLimit limit = pressing(0.001);
    is_guessed(limit, 0.01, 40);
    EXPECT_NEAR(limit.depth(), 0.001 + guessed_force / 500.0, 1e-12);
    is_guessed(limit, 0.01, 20);
    is_here(limit, 0.01);
    EXPECT_TRUE(limit.binds(Hand::here)) << "it comes back from an outage";
}

// A tick's guess passes for a sample: what it adds is no force that the operator is known to press with.
TEST(PressLimit, AGuessPressesHardlyMoreFromItsFirstTickOn) {
    PressLimit limit = pressing(0.001);
    is_here(limit, 0.0024);
    is_guessed(limit, 0.01, 4);
    EXPECT_NEAR(limit.depth(), 0.001 + guessed_force / 500.0, 1e-12);
}

// Without a model the operator cannot tell where a guess presses more. Every sample is followed by a guess:
// however many there were, none is late for it.
TEST(PressLimit, ShortGuessesOfDirectTeleoperationDoNotAddUp) {
    PressLimit limit = pressing(0.001);
    for (int i = 0; i < 20; ++i) {
        for (int tick = 0; tick < 15; ++tick) {
            PressLimit::In direct = in(Hand::guessed);
            direct.own_force.reset();
            limit.step(direct);
            limit.applied(Hand::guessed, 0.001);
        }
        EXPECT_GT(limit.depth(), 0.001 + 14 * PressLimit::rate * 0.001 / 500.0);
        EXPECT_FALSE(limit.binds(Hand::here));
        is_here(limit, 0.001);
    }
}

}  // namespace
}  // namespace tactus::press_limit_test
