#include "core/safety/hand_safety.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/safety/force_watch.hpp"
#include "core/safety/stiffness_limit.hpp"
#include "shared/safety_figures.hpp"

namespace tactus::hand_safety_test {
namespace {

SafetySample pushed(double newtons) {
    SafetySample sample;
    sample.wanted = {0.0, newtons, 0.0};
    return sample;
}

TEST(HandSafety, WithoutLimitsAForceLeavesAsItIs) {
    HandSafety safety;
    const SafeForce safe = safety.pass({}, pushed(1e6));
    EXPECT_EQ(safe.force, Vec3(0.0, 1e6, 0.0));
    EXPECT_EQ(safe.state, HandState::working);
    EXPECT_EQ(safe.limited, 0u);
}

TEST(HandSafety, TheForceGrowsFromNothingAfterEveryPause) {
    HandSafety safety;
    SafetySettings settings;
    settings.ramp = 0.1;
    const auto grows = [&] {
        for (int tick = 1; tick <= 100; ++tick) {
            EXPECT_NEAR(safety.pass(settings, pushed(2.0)).force.y, 0.02 * tick, 1e-12);
        }
        EXPECT_EQ(safety.pass(settings, pushed(2.0)).state, HandState::working);
    };
    grows();
    SafetySample held = pushed(2.0);
    held.enabled = false;
    EXPECT_EQ(safety.pass(settings, held).state, HandState::disabled);
    grows();
    SafetySample gone = pushed(2.0);
    gone.connected = false;
    EXPECT_EQ(safety.pass(settings, gone).state, HandState::disconnected);
    grows();
    safety.rest();
    grows();
}

TEST(HandSafety, AReadingWithoutSenseTakesTheForceAtOnceAndItGrowsAgain) {
    HandSafety safety;
    SafetySettings settings;
    settings.ramp = 0.1;
    const auto play = [&](const SafetySample& sample) { return safety.pass(settings, sample); };
    for (int tick = 0; tick < 200; ++tick) {
        play(pushed(2.0));
    }
    SafetySample nonsense = pushed(2.0);
    nonsense.sound = false;
    nonsense.rotation.w = std::nan("");
    EXPECT_EQ(play(nonsense).force, Vec3(0.0));
    EXPECT_EQ(play(nonsense).state, HandState::no_number);
    EXPECT_NEAR(play(pushed(2.0)).force.y, 0.02, 1e-12);
}

// An encoder that is stuck, while the velocity says that the hand moves.
TEST(HandSafety, APositionThatStaysWhileTheHandMovesIsNoReading) {
    SafetySettings settings;
    settings.sees_frozen = true;
    SafetySample sample = pushed(2.0);
    sample.velocity = {0.5, 0.0, 0.0};
    for (const double smoothed : {0.0, 0.004}) {
        HandSafety safety;
        settings.velocity_smoothed = smoothed;
        sample.position = Vec3(0.0);
        for (int tick = 0; tick < 10; ++tick) {
            sample.position.x += 5e-4;
            ASSERT_EQ(safety.pass(settings, sample).state, HandState::working);
        }
        int ticks = 0;
        while (safety.pass(settings, sample).state == HandState::working) {
            ASSERT_LT(++ticks, 20);
        }
        EXPECT_NEAR(ticks, smoothed > 0.0 ? 10 : 2, 1);
        EXPECT_EQ(safety.pass(settings, sample).state, HandState::frozen);
        sample.position.x += 5e-4;
        EXPECT_EQ(safety.pass(settings, sample).state, HandState::working);
    }
    // At rest nothing moves, and nothing is wrong.
    HandSafety safety;
    sample.velocity = Vec3(0.0);
    for (int tick = 0; tick < 10'000; ++tick) {
        ASSERT_EQ(safety.pass(settings, sample).state, HandState::working);
    }
}

// What a device says of a hand that goes on at a speed and stops dead after a share of a tick. Its velocity
// is smoothed to first order, or is the mean over a window that is twice as long.
class StoppedHand {
public:
    StoppedHand(double speed, double share, double smoothed, bool is_window)
        : speed_(speed), stop_(moving_ticks + share), smoothed_(smoothed), is_window_(is_window) {}

    static constexpr int moving_ticks = 100;
    SafetySample at(int tick) {
        SafetySample sample;
        sample.position.x = place(tick);
        const double truth = (place(tick) - place(tick - 1)) / sample.seconds;
        filtered_ += sample.seconds / (sample.seconds + smoothed_) * (truth - filtered_);
        const double window = std::max(1.0, 2.0 * smoothed_ / sample.seconds);  // ticks
        const double mean = (place(tick) - place(tick - window)) / (window * sample.seconds);
        sample.velocity.x = is_window_ ? mean : filtered_;
        return sample;
    }

private:
    double place(double tick) const { return 1e-3 * speed_ * std::min(tick, stop_); }

    double speed_, stop_, smoothed_;
    bool is_window_;
    double filtered_ = 0.0;
};

TEST(HandSafety, ADeadStopIsNoFrozenReading) {
    SafetySettings settings;
    settings.sees_frozen = true;
    for (const double smoothed : {0.0, 0.001, 0.004, 0.01}) {
        settings.velocity_smoothed = smoothed;
        for (const bool is_window : {false, true}) {
            for (const double speed : {0.05, 0.3, 1.0, 3.0, 5.0}) {
                for (const double share : {0.01, 0.5, 0.99}) {
                    HandSafety safety;
                    StoppedHand hand(speed, share, smoothed, is_window);
                    for (int tick = 0; tick < 3 * StoppedHand::moving_ticks; ++tick) {
                        ASSERT_EQ(safety.pass(settings, hand.at(tick)).state, HandState::working)
                            << smoothed << " s, " << (is_window ? "window" : "first order") << ", " << speed
                            << " m/s, tick " << tick;
                    }
                }
            }
        }
    }
}

// The smoothing that a device declares excuses no velocity that the hand did not have before.
TEST(HandSafety, AVelocityThatBeginsWhileThePositionStaysIsFrozenWithinAMillimeter) {
    SafetySettings settings;
    settings.sees_frozen = true;
    for (const double smoothed : {0.0, 0.001, 0.01}) {
        settings.velocity_smoothed = smoothed;
        HandSafety safety;
        SafetySample sample = pushed(2.0);
        for (int tick = 0; tick < 10; ++tick) {
            ASSERT_EQ(safety.pass(settings, sample).state, HandState::working);
        }
        sample.velocity.y = 0.4;
        for (int tick = 1; tick <= 2; ++tick) {
            EXPECT_EQ(safety.pass(settings, sample).state, HandState::working);
        }
        EXPECT_EQ(safety.pass(settings, sample).state, HandState::frozen);
    }
}

// A force acts from its tick on: the first has gone nowhere yet.
TEST(HandSafety, ItsWorkIsThatOfTheForcesThatWereGiven) {
    HandSafety safety;
    SafetySettings settings;
    settings.max_force = 3.0;
    settings.max_speed = 10.0;
    SafetySample sample = pushed(5.0);
    for (int tick = 0; tick <= 10; ++tick) {
        sample.position = {0.0, 0.001 * tick, 0.002 * tick};
        safety.pass(settings, sample);
    }
    EXPECT_NEAR(safety.work(), 3.0 * 0.01, 1e-12);
    sample.position.y = 5.0;  // a jump is no way of a hand
    safety.pass(settings, sample);
    EXPECT_NEAR(safety.work(), 3.0 * 0.01, 1e-12);
    sample.enabled = false;
    safety.pass(settings, sample);
    sample.position.y = 5.001;
    safety.pass(settings, sample);
    EXPECT_NEAR(safety.work(), 3.0 * 0.01, 1e-12) << "nothing is given";
}

TEST(HandSafety, ATorqueLeavesWithinItsOwnLimits) {
    HandSafety safety;
    SafetySettings settings;
    SafetySample sample;
    sample.torque = {0.0, 3.0, 0.0};
    EXPECT_EQ(safety.pass(settings, sample).torque, Vec3(0.0)) << "nothing can give it";
    settings.max_torque = 0.2;
    settings.torque_limits.slew = 50.0;
    for (int tick = 1; tick <= 10; ++tick) {
        const SafeForce safe = safety.pass(settings, sample);
        EXPECT_NEAR(safe.torque.y, std::min(0.2, 0.05 * tick), 1e-12);
        EXPECT_EQ(safe.limited, hand_limited_force);
        EXPECT_EQ(safe.force, Vec3(0.0));
    }
    sample.torque = Vec3(std::nan(""));
    EXPECT_EQ(safety.pass(settings, sample).limited & hand_limited_command, hand_limited_command);
    sample.torque = {0.0, 0.1, 0.0};
    sample.enabled = false;
    EXPECT_EQ(safety.pass(settings, sample).torque, Vec3(0.0));
    settings.ramp = 0.1;
    sample.enabled = true;
    EXPECT_NEAR(safety.pass(settings, sample).torque.y, 0.001, 1e-12) << "it grows from nothing";
}

// A handle that goes with the torque, faster and faster.
TEST(HandSafety, ATorqueGivesNoMorePowerThanIsAllowed) {
    HandSafety safety;
    SafetySettings settings;
    settings.max_torque = 1.0;
    settings.torque_limits = {SafetySettings::none, 0.01, 0.5};
    SafetySample sample;
    sample.torque = {0.0, 1.0, 0.0};
    double angle = 0.0, given = 0.0;
    for (int tick = 1; tick <= 1'000; ++tick) {
        const double spin = 0.02 * tick;
        angle += spin * sample.seconds;
        sample.rotation = {std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0};
        given += safety.pass(settings, sample).torque.y * spin * sample.seconds;
    }
    EXPECT_LE(given, 0.01 + 0.5 * 1.0 + 1e-9);
    EXPECT_GT(given, 0.4);
}

TEST(HandSafety, WithoutTheButtonThereIsNoForceAtOnce) {
    HandSafety safety;
    SafetySettings settings;
    settings.dead_man = 0b110;
    settings.limits.slew = 100.0;
    SafetySample sample = pushed(1.0);
    EXPECT_EQ(safety.pass(settings, sample).state, HandState::released);
    sample.buttons = 0b100;
    for (int tick = 0; tick < 20; ++tick) {
        safety.pass(settings, sample);
    }
    EXPECT_EQ(safety.pass(settings, sample).force.y, 1.0);
    sample.buttons = 0b001;
    EXPECT_EQ(safety.pass(settings, sample).force, Vec3(0.0));
}

TEST(HandSafety, ReadingsThatMakeNoSenseLetTheHandGo) {
    HandSafety safety;
    SafetySettings settings;
    settings.max_speed = 5.0;
    SafetySample sample = pushed(1.0);
    EXPECT_EQ(safety.pass(settings, sample).force.y, 1.0);
    sample.position.x = 0.006;
    SafeForce safe = safety.pass(settings, sample);
    EXPECT_EQ(safe.state, HandState::jumped);
    EXPECT_EQ(safe.force, Vec3(0.0));
    EXPECT_EQ(safety.pass(settings, sample).force.y, 1.0);
    sample.velocity.z = std::nan("");
    safe = safety.pass(settings, sample);
    EXPECT_EQ(safe.state, HandState::no_number);
    EXPECT_EQ(safe.force, Vec3(0.0));
    sample.velocity.z = 0.0;
    sample.wanted.y = std::nan("");
    safe = safety.pass(settings, sample);
    EXPECT_EQ(safe.force, Vec3(0.0));
    EXPECT_EQ(safe.limited, hand_limited_command);
}

TEST(HandSafety, NoRandomInputBreaksALimit) {
    const shared::SafetyFigures figures = shared::play_random_hand(1, 200'000);
    EXPECT_EQ(figures.violations, 0);
    EXPECT_GT(figures.working, 50'000);
}

// What is not pushed back is not stopped: a hand that a force drives on is braked until it has paid.
TEST(HandSafety, AForceThatMakesEnergyIsTakenBack) {
    HandSafety safety;
    SafetySettings settings;
    settings.passive = true;
    settings.max_damping = 50.0;
    SafetySample sample;
    double given = 0.0;
    Vec3 force(0.0);
    for (int tick = 0; tick < 1000; ++tick) {
        sample.velocity = {0.0, 0.2, 0.0};
        sample.position += sample.velocity * sample.seconds;
        given += glm::dot(force, sample.velocity) * sample.seconds;
        sample.wanted = {0.0, 3.0, 0.0};
        force = safety.pass(settings, sample).force;
    }
    EXPECT_LE(given, 1e-12);
}

// A hand that is another world's, say, which takes any energy: at rest its touch goes on.
TEST(HandSafety, AHandThatTakesAnythingFeelsItsForceAtRestAsWell) {
    HandSafety safety;
    SafetySettings settings;
    settings.passive = true;
    settings.damping = SafetySettings::none;
    for (int tick = 0; tick < 20; ++tick) {
        SafetySample sample = pushed(2.0);
        sample.velocity.y = tick > 10 ? 0.001 : 0.0;
        sample.position.y = tick > 10 ? 1e-6 * (tick - 10) : 0.0;
        const SafeForce safe = safety.pass(settings, sample);
        EXPECT_EQ(safe.force, Vec3(0.0, 2.0, 0.0)) << tick;
        EXPECT_EQ(safe.limited, 0u) << tick;
    }
}

TEST(SafeWall, IsWhatTheDampingBears) {
    const Wall stiff{3000.0, 0.0};
    EXPECT_NEAR(safe_wall({0.001, 0.0}, 1.5, stiff).stiffness, 3000.0, 1e-9);
    EXPECT_NEAR(safe_wall({0.001, 0.001}, 4.5, stiff).stiffness, 3000.0, 1e-9);
    EXPECT_NEAR(safe_wall({0.001, 0.040}, 8.505, {800.0, 0.0}).stiffness, 210.0, 1e-9);
    const double none = std::numeric_limits<double>::infinity();
    EXPECT_EQ(safe_wall({0.001, 0.040}, none, {1e9, 1e5}).stiffness, 1e9);
    EXPECT_EQ(safe_wall({0.001, 0.040}, none, {1e9, 1e5}).damping, 1e5);
    EXPECT_EQ(safe_wall({0.001, 0.0}, 0.0, stiff).stiffness, 0.0);
}

TEST(SafeWall, IsExplained) {
    EXPECT_EQ(explain_stiffness(800.0, 210.3, {0.001, 0.040}), "800 N/m is unsafe at 40 ms: 210 N/m used");
    EXPECT_EQ(explain_stiffness(800.0, 800.0, {0.001, 0.040}), "");
}

TEST(SafeWall, MakesNoEnergyAndComesToRestWhereAStifferOneDoesNot) {
    for (const double delay : {0.0, 0.005, 0.05}) {
        for (const double stiffness : {200.0, 20'000.0}) {
            const shared::ContactCase contact{{stiffness, 0.0}, {0.001, delay}};
            const shared::ContactFigures figures = shared::play_contact(contact);
            EXPECT_LE(figures.energy_created, 1e-6) << stiffness << " N/m, " << delay << " s";
            EXPECT_TRUE(figures.stable) << stiffness << " N/m, " << delay << " s";
        }
    }
    shared::ContactCase free{{20'000.0, 0.0}, {0.001, 0.005}};
    free.limited = free.passive = false;
    const shared::ContactFigures figures = shared::play_contact(free);
    EXPECT_FALSE(figures.stable);
    EXPECT_GT(figures.largest_created, 1e-3);
}

// Whatever the periods, the hand is free in time, and a tick that is late by a tenth of its period is no
// reason to release it.
TEST(ForceWatch, LivesFollowFromBothPeriods) {
    for (const double rate : {4000.0, 2000.0, 1000.0, 640.0, 595.0}) {
        const LoopPace pace{from_seconds(1.0 / rate), true};
        ASSERT_EQ(why_no_force(pace), "") << rate;
        for (const Nanoseconds exchange : {0, 250'000, 1'000'000}) {
            const ForceLife life = force_life(pace.period, exchange);
            EXPECT_GE(life.written, pace.period + pace.period / 10) << rate;
            EXPECT_LT(life.written + life.grace, free_within) << rate;
            EXPECT_GE(life.grace, 50'000) << rate;
            EXPECT_GT(life.sent, std::max(pace.period, exchange)) << rate;
            EXPECT_GT(life.heard, std::max(pace.period, exchange)) << rate;
        }
    }
}

TEST(ForceWatch, ALoopThatIsTooSlowOrSteppedIsRefusedWithAReason) {
    for (const double rate : {100.0, 250.0, 500.0, 590.0}) {
        EXPECT_NE(why_no_force({from_seconds(1.0 / rate), true}).find("595 or more"), std::string::npos)
            << rate;
    }
    EXPECT_NE(why_no_force({1'000'000, false}).find("stepped"), std::string::npos);
}

}  // namespace
}  // namespace tactus::hand_safety_test
