// A block on a table under a tip that presses, rubs and pushes it, with rough sensors: for tests and benches
// of what touch teaches.
#pragma once

#include <cmath>
#include <numbers>

#include "core/estimation/touch_estimate.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

struct TouchedBlock {
    double stiffness = 800.0;    // of its surface (unit: newtons per meter)
    double damping = 1.0;        // (unit: newton seconds per meter)
    double friction = 0.5;       // under the tip
    double on_table = 0.3;       // under the block
    double mass = 0.6;           // (unit: kilograms)
    double force_noise = 0.02;   // standard deviations of what is told (unit: newtons)
    double place_noise = 2e-5;   // (unit: meters)
    double speed_noise = 0.005;  // of the block (unit: meters per second)
    std::uint64_t seed = 1;
};

// For `seconds` in turns of half a second: pressing its top ever deeper and less deep while rubbing to and
// fro, then pushing its side.
inline TouchEstimate touch_block(const TouchedBlock& block, double seconds) {
    RandomValues random(block.seed);
    const auto chance = [&random] {
        return std::sqrt(3.0) * (random.between(-1.0, 1.0) + random.between(-1.0, 1.0)) / std::numbers::sqrt2;
    };
    const auto rough = [&chance](double deviation) { return deviation * Vec3(chance(), chance(), chance()); };
    constexpr double tick = 1e-3;
    constexpr double g = 9.81;
    TouchEstimate estimate;
    double speed = 0.0;  // of the block, along x
    bool pushed = false;
    for (int i = 0; i < static_cast<int>(seconds / tick); ++i) {
        const double t = i * tick;
        const bool pushes = std::fmod(t, 1.0) >= 0.5;
        if (pushes != pushed) {
            estimate.let_go();
            speed = 0.0;
            pushed = pushes;
        }
        TipSample sample;
        sample.seconds = tick;
        if (!pushes) {
            const double w = 2.0 * std::numbers::pi * 3.0;
            const double deep = 0.004 + 0.002 * std::sin(w * t), sinking = 0.002 * w * std::cos(w * t);
            const double sliding = 0.05 * std::cos(2.0 * std::numbers::pi * 2.0 * t);
            const double pressing = std::max(0.0, block.stiffness * deep + block.damping * sinking);
            sample.normal = {0.0, 1.0, 0.0};
            sample.tip = Vec3(0.0, -deep, 0.0) + rough(block.place_noise);
            sample.tip_velocity = {sliding, -sinking, 0.0};
            sample.force = Vec3((sliding > 0.0 ? 1.0 : -1.0) * block.friction * pressing, -pressing, 0.0);
        } else {
            const double resists = block.on_table * block.mass * g;
            const double push = resists * (1.6 + 0.5 * std::sin(2.0 * std::numbers::pi * 5.0 * t));
            speed = std::max(0.0, speed + tick * (push - resists) / block.mass);
            sample.normal = {-1.0, 0.0, 0.0};
            sample.tip = Vec3(push / block.stiffness, 0.0, 0.0) + rough(block.place_noise);
            sample.force = {push, 0.0, 0.0};
            sample.body_velocity = Vec3(speed, 0.0, 0.0) + rough(block.speed_noise);
        }
        sample.force += rough(block.force_noise);
        estimate.feel(sample);
    }
    return estimate;
}

}  // namespace tactus::shared
