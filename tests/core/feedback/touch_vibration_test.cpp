#include "core/feedback/touch_vibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/feedback/touch_sound.hpp"

namespace tactus::touch_vibration_test {
namespace {

constexpr double tick = 0.001;

// A finger that goes into a wall with constant speed and stays 5 mm deep.
std::vector<double> pressed(double stiffness, double speed, int ticks) {
    TouchVibration vibration;
    std::vector<double> all;
    for (int i = -10; i < ticks; ++i) {
        const double depth = std::min(0.005, std::max(0.0, i * tick * speed));
        all.push_back(vibration.next({{0.0, stiffness * depth, 0.0}, depth}, tick));
    }
    return all;
}

double largest(const std::vector<double>& values, std::size_t from = 0) {
    double found = 0.0;
    for (std::size_t i = from; i < values.size(); ++i) {
        found = std::max(found, std::abs(values[i]));
    }
    return found;
}

TEST(TouchVibration, NothingTouchedIsStill) {
    TouchVibration vibration;
    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(vibration.next({}, tick), 0.0);
        EXPECT_EQ(vibration.tap().size, 0.0);
    }
}

TEST(TouchVibration, ASteadyForceDoesNotVibrate) {
    EXPECT_LE(largest(pressed(500.0, 0.1, 1000), 800), 1e-6);
}

TEST(TouchVibration, AHarderWallRingsHigherAndStronger) {
    const Tap soft = tap_of(0.1, 200.0);
    const Tap hard = tap_of(0.1, 20'000.0);
    EXPECT_NEAR(hard.frequency / soft.frequency, 10.0, 1e-9);
    EXPECT_NEAR(hard.size / soft.size, 10.0, 1e-9);
    EXPECT_GT(largest(pressed(2000.0, 0.1, 100)), 2.0 * largest(pressed(200.0, 0.1, 100)));
}

TEST(TouchVibration, AFasterTouchIsStrongerAndASlowOneHardlyThere) {
    EXPECT_GT(largest(pressed(1000.0, 0.2, 100)), 1.5 * largest(pressed(1000.0, 0.1, 100)));
    EXPECT_LE(largest(pressed(1000.0, 0.001, 100)), 0.02);
}

TEST(TouchVibration, OneTouchIsOneTap) {
    TouchVibration vibration;
    int taps = 0;
    for (int i = 0; i < 300; ++i) {
        const double depth = i % 100 < 50 ? 0.0001 * (i % 100 + 1) : 0.0;
        vibration.next({{0.0, 500.0 * depth, 0.0}, depth}, tick);
        taps += vibration.tap().size > 0.0 ? 1 : 0;
    }
    EXPECT_EQ(taps, 3);
}

TEST(TouchVibration, ASurfaceThatIsLeftAtOnceOrMovesAwayIsNoTap) {
    EXPECT_EQ(tap_of(0.0, 500.0).size, 0.0);
    EXPECT_EQ(tap_of(-1.0, 500.0).size, 0.0);
    EXPECT_EQ(tap_of(1.0, 0.0).size, 0.0);
}

TEST(TouchVibration, WhatATextureAddsComesThroughWhole) {
    TouchVibration vibration;
    double found = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const double wave = 0.3 * std::sin(2.0 * std::numbers::pi * 150.0 * i * tick);
        const double heard = vibration.next({{0.0, 2.0 + wave, 0.0}, 0.004}, tick);
        found = i > 1000 ? std::max(found, std::abs(heard)) : 0.0;
    }
    EXPECT_NEAR(found, 0.3, 0.04);
}

TEST(Ring, TurnsAndDiesAwayAlikeInAnySteps) {
    Ring whole;
    Ring parts;
    whole.strike({1.0, 40.0});
    parts.strike({1.0, 40.0});
    whole.advance(40.0, 0.01);
    for (int i = 0; i < 100; ++i) {
        parts.advance(40.0, 0.0001);
    }
    EXPECT_NEAR(whole.sine, parts.sine, 1e-12);
    EXPECT_NEAR(whole.cosine, parts.cosine, 1e-12);
    whole.advance(40.0, 1.0);
    EXPECT_LE(std::hypot(whole.sine, whole.cosine), 1e-9);
}

TEST(MotorMeter, SlowAndFastHaveAMotorEach) {
    const auto levels = [](double frequency) {
        MotorMeter meter;
        for (int i = 0; i < 1000; ++i) {
            meter.add(std::sin(2.0 * std::numbers::pi * frequency * i * tick), Vec3(0.0), tick);
        }
        return meter.take({.full_force = 1.0});
    };
    EXPECT_GT(levels(25.0).heavy, 0.9);
    EXPECT_LT(levels(25.0).light, 0.35);
    EXPECT_GT(levels(300.0).light, 0.7);
    EXPECT_LT(levels(300.0).heavy, 0.35);
}

TEST(MotorMeter, AFirmerPressIsStrongerAndNothingIsMoreThanFull) {
    MotorMeter meter;
    EXPECT_EQ(meter.take({}).heavy, 0.0) << "no tick, no level";
    meter.add(0.0, {0.0, 2.0, 0.0}, tick);
    EXPECT_NEAR(meter.take({.full_force = 2.0, .steady_share = 0.25}).heavy, 0.25, 1e-12);
    meter.add(1000.0, {0.0, 1000.0, 0.0}, tick);
    const MotorLevels full = meter.take({});
    EXPECT_EQ(full.heavy, 1.0);
    EXPECT_EQ(full.light, 1.0);
}

TEST(TouchSound, NoSampleIsTooManyOrMissingAndNoneTooLoud) {
    for (const double rate : {11025.0, 22050.0, 44100.0, 48000.0}) {
        TouchSound sound(rate);
        std::vector<float> samples;
        for (int i = 0; i < 10'000; ++i) {
            sound.append(100.0 * std::sin(i), tap_of(i % 100 == 0 ? 10.0 : 0.0, 1e5), tick, 1.0, samples);
        }
        EXPECT_NEAR(static_cast<double>(samples.size()), 10.0 * rate, 1.0);
        for (const float sample : samples) {
            ASSERT_TRUE(sample >= -1.0f && sample <= 1.0f);
        }
    }
}

TEST(TouchSound, SilenceIsSilent) {
    TouchSound sound(22050.0);
    std::vector<float> samples;
    for (int i = 0; i < 100; ++i) {
        sound.append(0.0, {}, tick, 1.0, samples);
    }
    for (const float sample : samples) {
        ASSERT_EQ(sample, 0.0f);
    }
}

// The times at which the sound goes upwards through zero.
TEST(TouchSound, ATapIsHeardThreeOctavesHigher) {
    const Tap tap{0.5, 40.0};
    TouchSound sound(44100.0);
    std::vector<float> samples;
    sound.append(0.0, tap, tick, 1.0, samples);
    for (int i = 0; i < 5; ++i) {
        sound.append(0.0, {}, tick, 1.0, samples);
    }
    std::vector<double> crossings;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        if (samples[i - 1] < 0.0f && samples[i] >= 0.0f) {
            crossings.push_back(static_cast<double>(i) / 44100.0);
        }
    }
    ASSERT_GE(crossings.size(), 1u);
    EXPECT_NEAR(crossings.front(), 1.0 / 320.0, 1e-4);
}

}  // namespace
}  // namespace tactus::touch_vibration_test
