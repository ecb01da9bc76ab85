// A force that is told now and then, as the hand feels it in between.
#include "core/haptics/hand_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "core/haptics/measured_field.hpp"

namespace tactus::hand_field_test {
namespace {

constexpr Nanoseconds tick = 1'000'000;
constexpr Nanoseconds frame = 16 * tick;
constexpr Wall any{1e9, 1e9};

// As it is told of a spring to the origin in a fluid, by who looks at it where the hand is.
FieldMoment moment_of(double stiffness, double damping, const HandMotion& hand) {
    return {hand.position, hand.velocity, -stiffness * hand.position - damping * hand.velocity,
            Mat3(-stiffness), Mat3(-damping)};
}

FieldMoment even(const Vec3& force) {
    FieldMoment moment;
    moment.force = force;
    return moment;
}

Vec3 felt(HandField& field, const HandMotion& hand, Nanoseconds now, const Wall& safe = any) {
    field.begin_tick(now);
    return field.force(hand, safe);
}

TEST(HandField, NothingIsFeltOfWhatHasNeverBeenTold) {
    HandField field;
    EXPECT_EQ(field.begin_tick(5 * tick).stiffness, 0.0);
    EXPECT_EQ(field.force({{1.0, 2.0, 3.0}, {}}, any), Vec3(0.0));
}

TEST(HandField, ItBeginsWithoutAJumpAndIsWholeSoon) {
    HandField field;
    field.set(even({0.0, 4.0, 0.0}));
    Vec3 before(0.0), now(0.0);
    for (int i = 1; i <= 60; ++i) {
        now = felt(field, {}, i * tick);
        EXPECT_LE(glm::length(now - before), 0.1) << i;
        before = now;
    }
    EXPECT_DOUBLE_EQ(now.y, 4.0);
}

TEST(HandField, BetweenTwoFramesASpringInAFluidIsFeltAsTheHandGoes) {
    HandField field;
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const double t = 1e-3 * i;
        const HandMotion hand{0.03 * Vec3(std::sin(5.0 * t), std::cos(7.0 * t), 0.0),
                              0.03 * Vec3(5.0 * std::cos(5.0 * t), -7.0 * std::sin(7.0 * t), 0.0)};
        if (i % 16 == 0) {
            field.set(moment_of(200.0, 3.0, hand));
        }
        const Vec3 now = felt(field, hand, i * tick);
        if (i > 100) {
            worst = std::max(worst, glm::length(now + 200.0 * hand.position + 3.0 * hand.velocity));
        }
    }
    EXPECT_LT(worst, 1e-9) << "of 6 N";
    const Wall steepest = field.begin_tick(2000 * tick);
    EXPECT_NEAR(steepest.stiffness, 200.0 * std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(steepest.damping, 3.0 * std::sqrt(3.0), 1e-9);
}

// A drag that is felt a frame late swings up where it is strong for the mass it brakes: b delay / m > pi / 2.
TEST(HandField, AThickFluidBrakesALightHandAndDoesNotSwing) {
    constexpr double mass = 0.1, damping = 20.0, seconds = 1e-3;
    HandField field;
    HandMotion hand{{}, {0.5, 0.0, 0.0}};
    for (int i = 0; i < 500; ++i) {
        if (i % 16 == 0) {
            field.set(moment_of(0.0, damping, hand));
        }
        hand.velocity += felt(field, hand, i * tick) * (seconds / mass);
        hand.position += hand.velocity * seconds;
        ASSERT_GE(hand.velocity.x, 0.0) << i;
        ASSERT_LE(hand.velocity.x, 0.5) << i;
    }
    EXPECT_LT(hand.velocity.x, 1e-6);
}

TEST(HandField, FromOneMomentToTheNextItGoesOverEvenly) {
    HandField field;
    double largest = 0.0;
    Vec3 before(0.0);
    for (int i = 0; i < 1000; ++i) {
        if (i % 16 == 0) {
            field.set(even({i / 16 % 2 == 0 ? 1.0 : -1.0, 0.0, 0.0}));
        }
        const Vec3 now = felt(field, {}, i * tick);
        largest = i > 100 ? std::max(largest, glm::length(now - before)) : 0.0;
        before = now;
    }
    EXPECT_NEAR(largest, 2.0 / 16.0, 0.01) << "over the length of a frame";
}

TEST(HandField, OfAComputationThatHasFallenSilentNothingIsLeft) {
    HandField field;
    FieldMoment moment = even({0.0, 2.0, 0.0});
    moment.by_place = Mat3(-100.0);
    for (int i = 0; i < 10; ++i) {
        field.set(moment);
        felt(field, {}, i * frame);
    }
    const Nanoseconds last = 9 * frame;
    EXPECT_NEAR(felt(field, {}, last + HandField::lives).y, 2.0, 1e-12);
    EXPECT_NEAR(felt(field, {}, last + HandField::lives * 3 / 2).y, 1.0, 1e-9);
    EXPECT_EQ(felt(field, {}, last + 2 * HandField::lives), Vec3(0.0));
    EXPECT_EQ(field.begin_tick(last + 2 * HandField::lives).stiffness, 0.0) << "walls have it all again";
    field.set(moment);
    EXPECT_LT(felt(field, {}, last + 2 * HandField::lives + tick).y, 0.1) << "and begins anew";
}

TEST(HandField, ItIsNoStifferAndDampsNoMoreThanIsSafe) {
    HandField field;
    field.set(moment_of(5000.0, 50.0, {}));
    felt(field, {}, 0);
    const Wall safe{300.0, 2.0};
    EXPECT_NEAR(felt(field, {{0.001, 0.0, 0.0}, {}}, 60 * tick, safe).x, -0.3 / std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(felt(field, {{}, {0.1, 0.0, 0.0}}, 60 * tick, safe).x, -0.2 / std::sqrt(3.0), 1e-9);
}

TEST(HandField, FarFromWhereItWasLookedAtItGrowsNoMore) {
    HandField field;
    field.set(moment_of(100.0, 2.0, {}));
    felt(field, {}, 0);
    EXPECT_NEAR(felt(field, {{5.0, 0.0, 0.0}, {}}, 60 * tick).x, -100.0 * HandField::reach, 1e-9);
    EXPECT_NEAR(felt(field, {{}, {9.0, 0.0, 0.0}}, 60 * tick).x, -2.0 * HandField::speed_reach, 1e-9);
}

// An arm that is led to a place along x, against a force that a script computes sixty times a second.
struct LedArm {
    double shake = 0.0;  // in its last two seconds (unit: meters)
    double made = 0.0;   // energy beyond that of the force itself, at most (unit: joules)
    double rests = 0.0;  // in the mean of these two seconds (unit: meters)
    bool is_limited = false;
};

template <typename Force>
LedArm lead_arm(const Force& force, double from, double to, double damping, const Wall& safe) {
    constexpr double mass = 0.5, stiffness = 150.0, seconds = 1e-3, h = 0.5 * seconds;
    LedArm led;
    HandField field;
    double x = from, v = 0.0, given = 0.0, work = 0.0, least = 1e9, most = -1e9;
    double next_frame = 0.0;
    FieldMoment told;
    told.place.x = from;
    for (int i = 0; i < 4000; ++i) {
        const double gone = std::min(1.0, i * seconds);
        const double meant = from + (to - from) * gone, pace = gone < 1.0 ? to - from : 0.0;
        const double pull = stiffness * (meant - x - h * v) + damping * (pace - v) + given;
        const double acceleration = pull / (mass + h * damping + h * h * stiffness);
        const double way = seconds * (v + h * acceleration);
        work += (given - force(x + 0.5 * way)) * way;
        led.made = std::max(led.made, work);
        x += way;
        v += seconds * acceleration;
        if (i >= next_frame) {
            next_frame += 1000.0 / 60.0;
            const auto answer = [&](const HandMotion& at) {
                return std::optional(Vec3(force(at.position.x), 0.0, 0.0));
            };
            told = *measured_field({Vec3(x, 0.0, 0.0), Vec3(v, 0.0, 0.0)}, told, answer);
            field.set(told);
        }
        const Wall wanted = field.begin_tick(i * tick);
        const Vec3 now =
            field.force({Vec3(x, 0.0, 0.0), Vec3(v, 0.0, 0.0)},
                        {std::min(wanted.stiffness, safe.stiffness), std::min(wanted.damping, safe.damping)});
        given = std::clamp(now.x, -8.0, 8.0);
        led.is_limited = led.is_limited || field.is_limited();
        if (i >= 2000) {
            least = std::min(least, x);
            most = std::max(most, x);
            led.rests += x / 2000.0;
        }
    }
    led.shake = most - least;
    return led;
}

// It made 0.6 J and shook by 12 mm.
TEST(HandField, AForceThatLeapsOrIsTooSteepMakesNoEnergy) {
    const auto leap = [](double x) { return x <= 0.0 ? 5.0 : 0.0; };
    const auto ramp = [](double x) { return std::clamp(-5e3 * x, 0.0, 5.0); };
    const auto cliff = [](double x) { return x <= 0.0 ? 5.0 - 100.0 * x : 0.0; };
    for (const double safe : {1500.0, 1e9}) {
        for (const double damping : {10.0, 5.0}) {
            for (const LedArm& led : {lead_arm(leap, 0.03, -0.02, damping, {safe, 1e9}),
                                      lead_arm(ramp, 0.03, -0.02, damping, {safe, 1e9}),
                                      lead_arm(cliff, 0.03, -0.02, damping, {safe, 1e9})}) {
                EXPECT_LE(led.shake, 3e-3) << safe << " N/m, " << damping;
                EXPECT_LE(led.made, 0.01) << safe << " N/m, " << damping;
                EXPECT_NEAR(led.rests, 0.0, 3e-3) << safe << " N/m, " << damping;
                EXPECT_TRUE(led.is_limited);
            }
        }
    }
}

// Between two frames the hand has gone on by a part of a detent, or over it.
TEST(HandField, DetentsMakeNoEnergy) {
    for (const double length : {5e-3, 1e-2, 2e-2}) {
        const auto detents = [&](double x) { return std::sin(2.0 * std::numbers::pi * x / length); };
        for (const double damping : {10.0, 5.0}) {
            const LedArm led = lead_arm(detents, 0.03, -0.02, damping, {1500.0, 1e9});
            EXPECT_LE(led.shake, 3e-3) << length << " m, " << damping;
            EXPECT_LE(led.made, 0.01) << length << " m, " << damping;
        }
    }
}

// A hand that slides along a wall of 5 N, and presses it with a spring of 150 N/m from 20 mm behind it. It
// touches it along z; its way goes along x.
TEST(HandField, AWallThatAScriptMakesIsSlidAlongWithoutABuzz) {
    constexpr double mass = 0.5, damping = 8.0, stiffness = 150.0, seconds = 1e-3;
    const auto wall = [](const HandMotion& at) {
        return std::optional(Vec3(0.0, 0.0, at.position.z <= 0.0 ? 5.0 : 0.0));
    };
    HandField field;
    FieldMoment told;
    HandMotion hand{{0.0, 0.0, 0.01}, Vec3(0.0)};
    told.place = hand.position;
    Vec3 given(0.0);
    double made = 0.0, least = 1e9, most = -1e9;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 meant{0.1 * seconds * i, 0.0, std::max(-0.02, 0.01 - 0.03 * seconds * i)};
        const Vec3 pull =
            stiffness * (meant - hand.position) - damping * (hand.velocity - Vec3(0.1, 0.0, 0.0));
        hand.velocity += (pull + given) * (seconds / mass);
        const Vec3 way = hand.velocity * seconds;
        made += glm::dot(given - *wall({hand.position + 0.5 * way, {}}), way);
        hand.position += way;
        if (i % 16 == 0) {
            told = *measured_field(hand, told, wall);
            field.set(told);
        }
        given = felt(field, hand, i * tick, {1500.0, 1e9});
        if (i > 1500) {
            least = std::min(least, hand.position.z);
            most = std::max(most, hand.position.z);
        }
    }
    EXPECT_LE(most - least, 1e-3);
    EXPECT_NEAR(0.5 * (least + most), 0.0, 3e-3);
    EXPECT_LE(made, 0.01);
}

// What is counted is the force that was held times the way that it acted on: a hand that is put elsewhere has
// not been moved by it.
TEST(HandField, AHandThatIsPutElsewhereOwesNothing) {
    HandField field;
    FieldMoment moment = even({5.0, 0.0, 0.0});
    for (int i = 0; i < 300; ++i) {
        const Vec3 place{i < 200 ? 0.0 : 0.5, 0.0, 0.0};
        if (i % 16 == 0) {
            moment.place = place;
            moment.by_place = Mat3(i < 200 ? -100.0 : 0.0);
            field.set(moment);
        }
        const Vec3 now = felt(field, {place, {0.1, 0.0, 0.0}}, i * tick);
        if (i > 240) {
            EXPECT_FALSE(field.is_limited()) << i;
            EXPECT_NEAR(now.x, 5.0, 1e-9) << i;
        }
    }
}

// The damper takes back what the guess has given too much, and nothing else: energy that a script adds by
// itself is its to give.
TEST(HandField, AnEngineThatShakesIsFeltWhole) {
    HandField field;
    for (int i = 0; i < 2'000; ++i) {
        const double force = std::sin(2.0 * std::numbers::pi * 3.0 * 1e-3 * i);
        const HandMotion hand{{0.01 * force, 0.0, 0.0}, {}};
        if (i % 16 == 0) {
            FieldMoment moment = even({force, 0.0, 0.0});
            moment.place = hand.position;
            field.set(moment);
        }
        const Vec3 now = felt(field, hand, i * tick);
        EXPECT_FALSE(field.is_limited()) << i;
        if (i > 100) {
            EXPECT_NEAR(now.x, force, 0.35) << i << ": a frame late, and no weaker";
        }
    }
}

TEST(HandField, ASpringThatIsTooSteepIsFeltAsASofterOne) {
    for (const double stiffness : {2000.0, 4000.0, 6000.0}) {
        const auto spring = [&](double x) { return -stiffness * x; };
        const LedArm led = lead_arm(spring, 0.0, -0.02, 10.0, {1500.0, 1e9});
        EXPECT_LE(led.shake, 1e-3) << stiffness;
        EXPECT_LE(led.made, 0.01) << stiffness;
        EXPECT_TRUE(led.is_limited) << stiffness;
        EXPECT_NEAR(led.rests, -0.02 * 150.0 / (150.0 + 1500.0), 2e-4) << stiffness;
    }
}

// What does not depend on where the hand is, and what is no steeper than is safe, is felt as it is told.
TEST(HandField, AWindAndASoftSpringAreFeltWhole) {
    const LedArm wind = lead_arm([](double) { return 2.0; }, 0.03, -0.02, 10.0, {1500.0, 1e9});
    EXPECT_NEAR(wind.rests, -0.02 + 2.0 / 150.0, 2e-4);
    EXPECT_FALSE(wind.is_limited);
    const LedArm spring = lead_arm([](double x) { return -500.0 * x; }, 0.0, -0.02, 10.0, {1500.0, 1e9});
    EXPECT_NEAR(spring.rests, -0.02 * 150.0 / 650.0, 1e-4);
    EXPECT_FALSE(spring.is_limited);
}

}  // namespace
}  // namespace tactus::hand_field_test
