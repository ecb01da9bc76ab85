#include "core/teleop/felt_pointer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/teleop/felt_tool.hpp"
#include "core/teleop/wrench_passivity.hpp"
#include "shared/random_values.hpp"

namespace tactus::felt_pointer_test {
namespace {

constexpr double tick = 0.001;

FeltInput pressing(const Vec3& modelled, const Vec3& velocity = Vec3(0.0)) {
    return {modelled, velocity, 500.0, tick};
}

// A hand that has rubbed over something long enough for the tank to be full.
FeltPointer rubbed(const StealthSettings& settings, const Vec3& force) {
    FeltPointer pointer;
    for (int i = 0; i < 1000; ++i) {
        pointer.feel(settings, pressing(force, -0.1 * force / glm::length(force)));
    }
    return pointer;
}

TEST(FeltPointer, WithoutAChangeTheModelIsFeltToTheBit) {
    const StealthSettings settings;
    FeltPointer pointer;
    for (int i = 0; i < 100; ++i) {
        const Vec3 modelled(0.1 * i, std::sin(i), -0.3);
        EXPECT_EQ(pointer.feel(settings, pressing(modelled, {0.1, 0.0, 0.3})), modelled);
        EXPECT_EQ(pointer.state(), FeltState::together);
    }
}

TEST(FeltPointer, AChangeIsNotFeltInItsTickAndFadesUnnoticed) {
    const StealthSettings settings;
    const Vec3 before(0.0, 2.0, 0.0), after(0.2, 1.7, 0.0);
    FeltPointer pointer = rubbed(settings, before);
    pointer.hide(before, after);
    Vec3 felt = pointer.feel(settings, pressing(after));
    EXPECT_LT(glm::distance(felt, before), 0.02 * just_noticeable(settings, 2.0));
    EXPECT_EQ(pointer.state(), FeltState::bridged);
    int ticks = 1;
    for (Vec3 earlier = felt; pointer.state() != FeltState::together; ++ticks) {
        felt = pointer.feel(settings, pressing(after));
        if (ticks % 100 == 0) {
            EXPECT_LE(glm::distance(felt, earlier), just_noticeable(settings, 2.0) * 1.001) << ticks;
            earlier = felt;
        }
        ASSERT_LT(ticks, 2000);
    }
    EXPECT_EQ(felt, after);
}

TEST(FeltPointer, OnlyTheSizeIsKeptWhereAskedFor) {
    const StealthSettings settings;
    const Vec3 before(0.0, 2.0, 0.0), after(1.5, 0.0, 0.0);
    FeltPointer pointer = rubbed(settings, before);
    pointer.hide_size(before, after);
    const Vec3 felt = pointer.feel(settings, pressing(after));
    EXPECT_NEAR(glm::length(felt), 2.0, 0.01);
    EXPECT_NEAR(felt.y, 0.0, 1e-12);
}

TEST(FeltPointer, WhatIsTooLargeIsLetGoAndSaysSo) {
    const StealthSettings settings;
    const Vec3 before(0.0, 3.0, 0.0);
    FeltPointer pointer = rubbed(settings, before);
    pointer.hide(before, Vec3(0.0));
    double largest_change = 0.0;
    Vec3 last = before;
    int ticks = 0;
    do {
        const Vec3 felt = pointer.feel(settings, {Vec3(0.0), Vec3(0.0), 0.0, tick});
        EXPECT_EQ(pointer.begins_to_let_go(), ticks == 0);
        largest_change = std::max(largest_change, glm::distance(felt, last));
        last = felt;
        ASSERT_LT(++ticks, 400);
    } while (pointer.state() == FeltState::letting_go);
    EXPECT_LE(largest_change, 3.0 * tick / settings.let_go_seconds * 1.001);
    EXPECT_EQ(last, Vec3(0.0)) << "nothing of it lingers";
    EXPECT_GE(ticks, 0.6 * settings.let_go_seconds / tick);
}

// The hand goes along with what is hidden, so that its tank takes some of it back at each tick.
double hidden_after(double seconds, double change) {
    const StealthSettings settings;
    const Vec3 modelled(10.0, 0.0, 0.0);
    FeltPointer pointer = rubbed(settings, modelled);
    pointer.let_go();
    pointer.feel(settings, pressing(modelled));
    pointer.hide(modelled - Vec3(change, 0.0, 0.0), modelled);
    for (int i = 0; i * tick < seconds; ++i) {
        pointer.feel(settings, pressing(modelled, {-0.15, 0.0, 0.0}));
    }
    return glm::length(pointer.hidden());
}

TEST(FeltPointer, WhatTheTankTakesBackWhileLettingGoFades) {
    EXPECT_GT(hidden_after(0.1, 8.0), 4.0);
    EXPECT_EQ(hidden_after(5.0, 8.0), 0.0);
}

TEST(FeltPointer, WhatGetsTooLargeWhileLettingGoIsLetGoAsWell) {
    EXPECT_LT(hidden_after(0.15, 12.0), 0.1);
}

// A hand that leaves a surface leaves what is hidden there with it.
TEST(FeltPointer, NothingIsFeltWhereNothingIsTouchedAnyMore) {
    const StealthSettings settings;
    const Vec3 before(0.0, 2.0, 0.0);
    FeltPointer pointer = rubbed(settings, before);
    pointer.hide(before, {0.0, 1.5, 0.0});
    Vec3 felt(0.0);
    for (double modelled = 1.5; modelled > 0.0; modelled -= 0.01) {
        felt = pointer.feel(settings, pressing({0.0, modelled, 0.0}, {0.0, 0.02, 0.0}));
        EXPECT_LE(felt.y, 2.0 * modelled + 2.0 * just_noticeable(settings, 0.0));
    }
    EXPECT_LT(glm::length(felt), 0.05);
}

// What is let go of goes over into what is modelled, whatever the model does meanwhile.
TEST(FeltPointer, AModelThatIsToMoveOtherwiseIsLetGoOf) {
    const StealthSettings settings;
    FeltPointer pointer = rubbed(settings, {0.0, 3.0, 0.0});
    pointer.let_go();
    Vec3 last(0.0, 3.0, 0.0);
    int ticks = 0;
    for (double modelled = 3.0; ticks == 0 || pointer.state() == FeltState::letting_go; ++ticks) {
        modelled = std::max(0.0, modelled - 0.5);  // it flies off at 1 m/s
        const Vec3 felt =
            pointer.feel(settings, {{0.0, modelled, 0.0}, Vec3(0.0), modelled > 0.0 ? 500.0 : 0.0, tick});
        EXPECT_EQ(pointer.begins_to_let_go(), ticks == 0);
        EXPECT_LE(glm::distance(felt, last), 3.0 * tick / settings.let_go_seconds * 1.1);
        last = felt;
        ASSERT_LT(ticks, 400);
    }
    EXPECT_EQ(last, Vec3(0.0));
}

// A touch that is about to end by itself is not held on to because it has ended already.
TEST(FeltPointer, WhatFallsAlreadyIsLetGoOfAtLeastAsFast) {
    const StealthSettings settings;
    constexpr double falling = 0.1;  // in a tick (unit: newtons)
    FeltPointer pointer;
    double modelled = 2.0;
    for (; modelled > 1.0; modelled -= falling) {
        pointer.feel(settings, pressing({0.0, modelled, 0.0}));
    }
    pointer.hide({0.0, modelled, 0.0}, Vec3(0.0));
    double last = modelled + falling;
    int ticks = 0;
    for (double felt = 1.0; felt > 0.0; last = felt) {
        felt = pointer.feel(settings, {Vec3(0.0), Vec3(0.0), 0.0, tick}).y;
        EXPECT_LE(last - felt, 1.1 * falling);
        ASSERT_LE(++ticks, 12);
    }
}

// A model that is changed at random, every tick, under a hand that moves at random: what hiding gives never
// exceeds what touch has taken before.
// A body that is torn away, put back and torn away again, say, by a joint that no honest side would tell.
TEST(FeltPointer, HoweverWildlyTheModelChangesAStillHandFeelsNoStep) {
    const StealthSettings settings;
    shared::RandomValues random(11);
    for (int run = 0; run < 400; ++run) {
        const double largest = random.magnitude(0.05, 5.0), rest = random.unit();
        const int every = 1 + random.below(30), each = 1 + random.below(3);
        const bool touches_nothing_between = random.flip();
        FeltPointer pointer = rubbed(settings, {0.0, largest, 0.0});
        Vec3 modelled(0.0, largest, 0.0), felt = modelled;
        for (int i = 0; i < 1'000; ++i) {
            if (i % every < each) {
                const Vec3 before = modelled;
                const bool nothing = touches_nothing_between && i % every == each - 1;
                const Vec3 varied = Vec3(0.0, largest, 0.0) * rest + random.in_ball(largest) * (1.0 - rest);
                modelled = nothing ? Vec3(0.0) : varied;
                pointer.hide(before, modelled);
            }
            const double stiffness = modelled == Vec3(0.0) ? 0.0 : 500.0;
            const Vec3 now = pointer.feel(settings, {modelled, Vec3(0.0), stiffness, tick});
            ASSERT_LE(glm::distance(now, felt), 0.3) << run << ", tick " << i;
            felt = now;
        }
    }
}

TEST(FeltPointer, WhatIsHiddenNeverAddsEnergyThatTouchHasNotTaken) {
    const StealthSettings settings;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        FeltPointer pointer;
        std::uint32_t random = seed;
        const auto number = [&random] {
            random = random * 1664525u + 1013904223u;
            return static_cast<double>(random >> 8) / (1 << 24) * 2.0 - 1.0;
        };
        double taken = 0.0;  // by the modelled force, for good
        double stored = 0.0;
        Vec3 modelled(0.0), held(0.0), velocity(0.0);
        for (int i = 0; i < 5000; ++i) {
            velocity += Vec3(number(), number(), number()) * 0.01 - velocity * 0.02;
            const Vec3 next(0.3 * number(), 2.0 + number(), 0.3 * number());
            if (i % 7 == 0) {
                pointer.hide(modelled, next);
            }
            // The force of the last tick has acted on the way of this one.
            const double now = 0.5 * glm::dot(next, next) / 500.0;
            taken -= glm::dot(held, velocity) * tick + now - stored;
            stored = now;
            modelled = held = next;
            pointer.feel(settings, pressing(modelled, velocity));
            // The tank forgets what it has no room for; it never invents any.
            ASSERT_LE(pointer.energy().tank_J, settings.tank + 1e-12);
            ASSERT_GE(pointer.energy().tank_J, -settings.tank - 1e-12);
        }
        EXPECT_LE(pointer.energy().hidden_J, std::max(0.0, taken) + settings.tank) << seed;
    }
}

// Taps on a wall: a sampled wall gives more than it has taken, as is known, and the figure says so.
TEST(FeltPointer, WorkIsThatOfTheForceThatWasHeld) {
    constexpr double stiffness = 1000.0, speed = 0.2;
    const StealthSettings settings;
    FeltPointer pointer;
    double outside = 0.0, force = 0.0, x = 0.0;
    for (int tap = 0; tap < 20; ++tap) {
        for (int i = 0; i < 200; ++i) {
            const double velocity = i < 100 ? -speed : speed;
            x += velocity * tick;
            outside += force * velocity * tick;
            force = std::max(0.0, -stiffness * (x - 0.005));
            pointer.feel(settings,
                         {{0.0, force, 0.0}, {0.0, velocity, 0.0}, force > 0.0 ? stiffness : 0.0, tick});
        }
    }
    EXPECT_GT(outside, 0.03);
    EXPECT_NEAR(pointer.energy().hand_J, outside, 1e-9);
    EXPECT_LE(pointer.energy().tank_J, 0.0) << "no energy that the hand has not put in";
}

TEST(FeltPointer, AnEmptyTankLetsNothingHelpTheHand) {
    const StealthSettings settings;
    FeltPointer pointer;
    pointer.hide({0.0, 2.0, 0.0}, {0.0, 1.5, 0.0});
    for (int i = 0; i < 100; ++i) {
        const Vec3 felt = pointer.feel(settings, pressing({0.0, 1.5, 0.0}, {0.0, 0.1, 0.0}));
        EXPECT_LE(felt.y, 1.5 + 1e-12);
    }
    EXPECT_LE(pointer.energy().hidden_J, 1e-12);
    EXPECT_GT(pointer.energy().damped_J, 0.0);
}

// --- a hand that holds a tool

constexpr double coupling_length = 0.03;

FeltToolInput pressed_with(const Wrench& wrench) {
    return {wrench, Vec3(0.0), Vec3(0.0), 1000.0, coupling_length, 1e-3};
}

TEST(FeltTool, WhatIsNotChangedIsFeltToTheBit) {
    FeltTool felt;
    const Wrench wrench{{1.0, 2.0, -3.0}, {0.1, 0.07, 0.003}};
    for (int i = 0; i < 10; ++i) {
        const Wrench given = felt.feel({}, pressed_with(wrench));
        EXPECT_EQ(given.force, wrench.force);
        EXPECT_EQ(given.torque, wrench.torque);
    }
    EXPECT_EQ(felt.state(), FeltState::together);
}

TEST(FeltTool, AChangeOfTheTorqueIsHiddenAndFadesUnnoticed) {
    FeltTool felt;
    const Wrench before{{0.0, 2.0, 0.0}, {0.0, 0.0, 0.05}}, after{{0.0, 2.0, 0.0}, {0.0, 0.0, 0.06}};
    Wrench given = felt.feel({}, pressed_with(before));
    felt.hide(before, after, coupling_length);
    const StealthSettings settings;
    for (int i = 0; i < 2'000; ++i) {
        const Wrench now = felt.feel(settings, pressed_with(after));
        const double noticed = just_noticeable(settings, 0.06 / coupling_length) * coupling_length;
        EXPECT_LT(glm::distance(now.torque, given.torque), noticed * 1e-3 / settings.window) << i;
        EXPECT_EQ(now.force, after.force);
        given = now;
    }
    EXPECT_EQ(given.torque, after.torque);
}

TEST(WrenchPassivity, GivesNoMoreThanItWasGiven) {
    WrenchPassivity passivity;
    shared::RandomValues random(4);
    double given = 0.0;
    for (int i = 0; i < 20'000; ++i) {
        const Wrench wrench{random.in_ball(10.0), random.in_ball(0.3)};
        const Vec3 velocity = random.in_ball(0.2), spin = random.in_ball(3.0);
        const Wrench passed = passivity.pass(wrench, velocity, spin, coupling_length, 1e-3);
        passivity.moved(passed, velocity * 1e-3, spin * 1e-3);
        given += (glm::dot(passed.force, velocity) + glm::dot(passed.torque, spin)) * 1e-3;
        EXPECT_LE(given, 1e-12);
    }
    EXPECT_LT(given, -1e-3);
}

}  // namespace
}  // namespace tactus::felt_pointer_test
