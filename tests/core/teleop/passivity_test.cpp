#include "core/teleop/passivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/teleop/errors.hpp"

namespace tactus::passivity_test {
namespace {

constexpr double tick = 1e-3;

struct Pressing {
    double created = 0.0;   // at the hand, in one contact (unit: joules)
    double deepest = 0.0;   // of the far hand (unit: meters)
    double restless = 0.0;  // mean speed of the hand while it holds still (unit: meters per second)
    double felt = 0.0;      // at the end of the hold (unit: newtons)
};

// An arm of 0.5 kg goes down to 30 mm below the surface of a wall, holds, and comes up again; `there` ticks
// each way.
Pressing press(Passivity scheme, std::size_t there, double wall) {
    const PassivitySettings settings;
    const auto near = std::make_unique<OperatorPassivity>();
    FarPassivity far;
    Pressing result;
    PortEnergy port;
    std::vector<Vec3> hands{Vec3(0.0)}, forces{Vec3(0.0)}, answers{Vec3(0.0)};
    double y = 0.05, speed = 0.0, far_y = 0.05;
    Vec3 force(0.0), answer(0.0);
    for (std::size_t t = 1; t <= 5000; ++t) {
        const double time = static_cast<double>(t) * tick;
        const double down = std::clamp((time - 0.2) / 0.4, 0.0, 1.0);
        const double up = std::clamp((time - 4.0) / 0.5, 0.0, 1.0);
        const double meant = 0.05 - 0.08 * (down - up);
        const double before = y;
        speed += tick * (150.0 * (meant - y) - 10.0 * speed + force.y) / 0.5;
        y += tick * speed;
        port.add(force, {0.0, y - before, 0.0});
        OperatorPassivity::In in;
        in.sample = t;
        in.hand = {0.0, y, 0.0};
        in.velocity = {0.0, speed, 0.0};
        if (t > 2 * there + 1) {
            in.far_sample = t - 2 * there - 1;
            in.far_force = answers[in.far_sample];
        }
        if (in.far_sample != 0) {
            force = near->force(scheme, settings, in);
            force.y = std::clamp(force.y, -10.0, 10.0);
            near->given(settings, force, tick);
        } else {
            near->rest(settings, in);  // the hand is under way before anybody has answered
        }
        hands.push_back(in.hand);
        forces.push_back(force);
        if (t > there) {
            const std::size_t played = t - there;
            const double was = far_y;
            far_y = far.hand(scheme, settings, {played, hands[played], forces[played], answer, tick}).y;
            const double pressed = -far_y > 0.0 ? wall * -far_y - 0.5 * (far_y - was) / tick : 0.0;
            answer = {0.0, std::max(0.0, pressed), 0.0};
            answers.push_back(answer);
            result.deepest = std::max(result.deepest, -far_y);
        }
        if (time > 3.0 && time <= 3.9) {
            result.restless += std::abs(speed) / 900.0;
            result.felt = force.y;
        }
    }
    result.created = port.created();
    return result;
}

TEST(Passivity, WithoutASchemeADelayedWallBounces) {
    EXPECT_GT(press(Passivity::none, 50, 500.0).created, 0.1);
    EXPECT_GT(press(Passivity::none, 50, 500.0).restless, 0.1);
}

TEST(Passivity, NoSchemeMakesEnergyAtAnyDelay) {
    for (const Passivity scheme :
         {Passivity::wave_variables, Passivity::time_domain, Passivity::two_layers}) {
        for (const std::size_t there : {0u, 12u, 25u, 50u, 100u, 250u}) {
            for (const double wall : {100.0, 500.0, 1000.0}) {
                const Pressing pressing = press(scheme, there, wall);
                const std::string name = std::to_string(static_cast<int>(scheme)) + " " +
                                         std::to_string(there) + " " + std::to_string(wall);
                EXPECT_LE(pressing.created, 1e-6) << name;
                EXPECT_LT(pressing.restless, 0.02) << name;
            }
        }
    }
}

TEST(Passivity, AWallIsFeltWithoutADelay) {
    EXPECT_NEAR(press(Passivity::two_layers, 0, 500.0).felt, press(Passivity::none, 0, 500.0).felt, 0.05);
    EXPECT_NEAR(press(Passivity::time_domain, 0, 500.0).felt, press(Passivity::none, 0, 500.0).felt, 0.05);
    EXPECT_GT(press(Passivity::wave_variables, 0, 500.0).felt, 2.0);
}

TEST(Passivity, FreeSpaceIsFree) {
    OperatorPassivity near;
    const PassivitySettings settings;
    for (std::uint64_t t = 1; t < 500; ++t) {
        OperatorPassivity::In in;
        in.sample = t;
        in.hand = {1e-4 * static_cast<double>(t), 0.0, 0.0};
        in.velocity = {0.1, 0.0, 0.0};
        in.far_sample = t > 100 ? t - 100 : 0;
        EXPECT_EQ(near.force(Passivity::time_domain, settings, in), Vec3(0.0));
    }
}

TEST(Passivity, AFarHandThatHasYieldedComesBack) {
    FarPassivity far;
    PassivitySettings settings;
    settings.far_store = 0.0;
    Vec3 hand(0.0);
    std::uint64_t sample = 0;
    const auto go = [&](double y, double pressed) {
        hand = far.hand(Passivity::time_domain, settings,
                        {++sample, {0.0, y, 0.0}, Vec3(0.0), {0.0, pressed, 0.0}, tick});
    };
    go(0.0, 0.0);
    for (int i = 1; i <= 10; ++i) {
        go(-1e-4 * i, 1.0);
    }
    EXPECT_GT(hand.y, -5e-4);  // nothing has been paid for
    for (int i = 0; i < 2000; ++i) {
        go(-1e-3, 0.0);
    }
    EXPECT_NEAR(hand.y, -1e-3, 1e-6);
}

}  // namespace
}  // namespace tactus::passivity_test
