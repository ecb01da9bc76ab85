#include "core/teleop/passivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/teleop/errors.hpp"
#include "shared/random_values.hpp"

namespace tactus::passivity_test {
namespace {

constexpr double tick = 1e-3;

struct Pressing {
    double created = 0.0;   // at the hand, in one contact (unit: joules)
    double deepest = 0.0;   // of the far hand (unit: meters)
    double restless = 0.0;  // mean speed of the hand while it holds still (unit: meters per second)
    double felt = 0.0;      // at the end of the hold (unit: newtons)
    double both = 0.0;      // at both ports together, the most that has been made (unit: joules)
};

// What may be lost on its way, and how late it comes.
struct Way {
    double loss = 0.0;
    std::size_t burst = 1;    // so many in a row
    std::size_t unheard = 0;  // no answer comes before this tick
};

// An arm of 0.5 kg goes down to 30 mm below the surface of a wall, holds, and comes up again; `there` ticks
// each way.
Pressing press(Passivity scheme, std::size_t there, double wall, const Way& way = {},
               const PassivitySettings& settings = {}) {
    shared::RandomValues random(static_cast<unsigned>(there) + 5);
    std::size_t lost_there = 0, lost_back = 0;
    const auto is_lost = [&](std::size_t& left) {
        left = left > 0                                                    ? left - 1
               : random.unit() * static_cast<double>(way.burst) < way.loss ? way.burst
                                                                           : 0;
        return left > 0;
    };
    double at_hand = 0.0, at_far = 0.0;
    Vec3 had_answer(0.0);
    std::vector<double> taken{0.0};
    std::size_t played = 0, heard = 0;
    const auto near = std::make_unique<OperatorPassivity>();
    FarPassivity far;
    Pressing result;
    PortEnergy port;
    std::vector<Vec3> hands{Vec3(0.0)}, forces{Vec3(0.0)}, answers{Vec3(0.0)};
    double y = 0.05, speed = 0.0, far_y = 0.05;
    Vec3 force(0.0), answer(0.0);
    std::vector<std::size_t> answered_by{0};  // by tick of the far end
    for (std::size_t t = 1; t <= 5000; ++t) {
        const double time = static_cast<double>(t) * tick;
        const double down = std::clamp((time - 0.2) / 0.4, 0.0, 1.0);
        const double up = std::clamp((time - 4.0) / 0.5, 0.0, 1.0);
        const double meant = 0.05 - 0.08 * (down - up);
        const double before = y;
        speed += tick * (150.0 * (meant - y) - 10.0 * speed + force.y) / 0.5;
        y += tick * speed;
        port.add(force, {0.0, y - before, 0.0});
        at_hand += force.y * (y - before);
        OperatorPassivity::In in;
        in.sample = t;
        in.hand = {0.0, y, 0.0};
        in.velocity = {0.0, speed, 0.0};
        if (t > std::max(2 * there + 1, way.unheard) && !is_lost(lost_back)) {
            heard = std::max(heard, answered_by[t - there - 1]);
        }
        if (heard > 0) {
            in.far_sample = heard;
            in.far_force = answers[heard];
            in.far_taken = taken[heard];
        }
        if (in.far_sample != 0) {
            force = near->force(scheme, settings, in);
            force.y = std::clamp(force.y, -10.0, 10.0);
            near->given(settings, force, tick);
        } else {
            near->rest(scheme, settings, in);  // the hand is under way before anybody has answered
        }
        hands.push_back(in.hand);
        forces.push_back(near->told());
        if (t > there && !is_lost(lost_there)) {
            played = t - there;
        }
        if (played > 0) {
            const double was = far_y;
            far_y = far.hand(scheme, settings, {played, hands[played], forces[played], answer, tick}).y;
            at_far -= had_answer.y * (far_y - was);
            const double pressed = -far_y > 0.0 ? wall * -far_y - 0.5 * (far_y - was) / tick : 0.0;
            answer = {0.0, std::max(0.0, pressed), 0.0};
            had_answer = answer;
            answers.resize(played + 1, Vec3(0.0));
            taken.resize(played + 1, 0.0);
            answers[played] = answer;
            taken[played] = far.taken();
            result.deepest = std::max(result.deepest, -far_y);
        }
        answered_by.push_back(played);
        result.both = std::max(result.both, at_hand + at_far);
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

// Stiffness times delay stays below k tau: here the arm's own 150 N/m are stiffer than what is displayed.
TEST(Passivity, ASpringThatIsSofterTheOlderItsForceCalmsADelayedWall) {
    PassivitySettings soft;
    soft.softening = 0.02;
    for (const std::size_t there : {25u, 50u, 100u, 250u}) {
        EXPECT_GT(press(Passivity::none, there, 500.0).restless, 0.1) << there;
        EXPECT_LT(press(Passivity::none, there, 500.0, {}, soft).restless, 0.02) << there;
    }
}

TEST(Passivity, AForceThatIsOneSofteningOldIsHalved) {
    PassivitySettings soft;
    soft.softening = 0.05;
    OperatorPassivity near;
    OperatorPassivity::In in;
    in.sample = 120;
    in.far_sample = 70;
    in.far_force = {0.0, 3.0, 0.0};
    EXPECT_NEAR(near.force(Passivity::none, soft, in).y, 1.5, 1e-12);
    EXPECT_EQ(near.force(Passivity::none, {}, in).y, 3.0);
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

// Both ports together give no more than what the ends may spend before they have heard of any.
TEST(Passivity, BothPortsTogetherMakeNoMoreThanTheirStores) {
    for (const Passivity scheme :
         {Passivity::wave_variables, Passivity::time_domain, Passivity::two_layers}) {
        for (const std::size_t there : {0u, 2u, 5u, 25u, 100u, 250u}) {
            for (const Way& way : {Way{}, Way{0.1, 1}, Way{0.2, 30}}) {
                for (const double wall : {100.0, 500.0, 1000.0}) {
                    const PassivitySettings settings;
                    const double store = scheme == Passivity::wave_variables ? 1e-4
                                         : scheme == Passivity::time_domain
                                             ? settings.reserve + settings.far_store
                                             : settings.reserve + settings.far_store + settings.tank;
                    EXPECT_LE(press(scheme, there, wall, way).both, store + 1e-9)
                        << static_cast<int>(scheme) << " " << there << " " << way.loss << " " << wall;
                }
            }
        }
    }
}

// A hand that nothing opposes gives the link no energy, however fast it moves: the far hand may press with
// none.
TEST(Passivity, AHandThatHearsNoAnswerYetSendsNoWaves) {
    for (const std::size_t there : {0u, 25u, 100u, 250u}) {
        for (const std::size_t unheard : {400u, 550u, 750u, 2500u}) {
            const Way late{0.0, 1, unheard};
            EXPECT_LE(press(Passivity::wave_variables, there, 500.0, late).both, 1e-4)
                << there << " " << unheard;
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

// In free space, `there` ticks each way: the hand goes 0.2 m in a second and is held where it stops.
struct Stopped {
    double felt = 0.0;  // most, from 1.5 s and three round trips after it has stopped on (unit: newtons)
    double off = 0.0;   // of the far hand from the operator's, likewise (unit: meters)
};

Stopped stop_in_free_space(std::size_t there, const PassivitySettings& settings) {
    const auto near = std::make_unique<OperatorPassivity>();
    FarPassivity far;
    std::vector<Vec3> hands{Vec3(0.0)}, forces{Vec3(0.0)};
    Stopped result;
    for (std::size_t t = 1; t <= 8000; ++t) {
        OperatorPassivity::In in;
        in.sample = t;
        in.hand = {0.2 * std::clamp(static_cast<double>(t) * tick - 1.0, 0.0, 1.0), 0.0, 0.0};
        in.velocity = (in.hand - hands.back()) / tick;
        in.far_sample = t > 2 * there + 1 ? t - 2 * there - 1 : 0;
        Vec3 force(0.0);
        if (in.far_sample != 0) {
            force = near->force(Passivity::wave_variables, settings, in);
            near->given(settings, force, tick);
        } else {
            near->rest(Passivity::wave_variables, settings, in);
        }
        hands.push_back(in.hand);
        forces.push_back(near->told());
        if (t <= there) {
            continue;
        }
        const std::size_t played = t - there;
        const Vec3 at = far.hand(Passivity::wave_variables, settings,
                                 {played, hands[played], forces[played], Vec3(0.0), tick});
        if (t > 3500 + 6 * there) {
            result.felt = std::max(result.felt, glm::length(force));
            result.off = std::max(result.off, glm::distance(at, in.hand));
        }
    }
    return result;
}

TEST(Passivity, WavesComeToRestInFreeSpace) {
    PassivitySettings soft, stiff;
    soft.impedance = 4.39;
    soft.wave_cutoff = 3.78;
    soft.drift_rate = 0.503;
    stiff.impedance = 60.0;
    for (const PassivitySettings& settings : {PassivitySettings{}, soft, stiff}) {
        for (const std::size_t there : {0u, 10u, 50u, 100u, 250u}) {
            const Stopped stopped = stop_in_free_space(there, settings);
            EXPECT_LE(stopped.felt, 0.5) << settings.impedance << " " << there;
            EXPECT_LE(stopped.off, settings.drift_rate > 1.0 ? 0.002 : 0.01)
                << settings.impedance << " " << there;
        }
    }
}

// In free space, at 0.2 m/s: two processes whose ticks begin at other times hear two answers in one tick and
// none in the next.
TEST(Passivity, WavesThatComeTwoAtATimeAreFeltAsSmoothly) {
    const PassivitySettings settings;
    const auto near = std::make_unique<OperatorPassivity>();
    OperatorPassivity::In in;
    in.velocity = {0.2, 0.0, 0.0};
    Vec3 before(0.0);
    double step = 0.0;
    for (std::uint64_t t = 1; t <= 2000; ++t) {
        in.sample = t;
        in.hand += in.velocity * tick;
        for (std::uint64_t heard = t - 4; t > 6 && t % 2 == 0 && heard < t - 2; ++heard) {
            in.far_sample = heard;
            near->hear(Passivity::wave_variables, settings, in);
        }
        const Vec3 force = near->force(Passivity::wave_variables, settings, in);
        step = t > 1000 ? std::max(step, glm::distance(force, before)) : 0.0;
        before = force;
    }
    EXPECT_LT(step, 0.1);
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

// The hand stands and presses, and half a second of samples is lost.
TEST(Passivity, AFarHandDoesNotLeapAfterAGap) {
    FarPassivity far;
    FarPassivity::In in;
    in.force.y = in.own_force.y = 5.0;
    double before = 0.0;
    for (int i = 0; i < 400; ++i) {
        in.sample += i == 200 ? 500 : 1;
        const double at = far.hand(Passivity::wave_variables, {}, in).y;
        EXPECT_LE(std::abs(at - before), 1e-3) << i;
        before = at;
    }
}

// Samples come late and in lumps, so that more is played than has come and waves are scaled. Then the hand
// stands and feels nothing: what rounding has left of the waves is no wave.
TEST(Passivity, AFarHandIsSomewhereWhateverComesLate) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        shared::RandomValues random(seed);
        FarPassivity far;
        PassivitySettings settings;
        FarPassivity::In in;
        for (int i = 0; i < 200; ++i) {
            const bool stands = i >= 100;
            in.sample += static_cast<std::uint64_t>(random.between(0.0, 4.0));
            in.hand.y += stands ? 0.0 : random.between(-1e-3, 1e-3);
            in.force.y = stands ? 0.0 : random.between(-5.0, 5.0);
            in.own_force.y = stands ? 0.0 : random.between(-5.0, 5.0);
            ASSERT_TRUE(std::isfinite(far.hand(Passivity::wave_variables, settings, in).y))
                << seed << " " << i;
        }
    }
}

}  // namespace
}  // namespace tactus::passivity_test
