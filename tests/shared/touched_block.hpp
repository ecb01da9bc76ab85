// A block on a table under a tip that presses, rubs and pushes it, with rough sensors and late eyes: for
// tests of what touch teaches.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/estimation/touch_estimate.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

struct TouchedBlock {
    double stiffness = 800.0;    // of its surface, in all directions (unit: newtons per meter)
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
    double speed = 0.0, place = 0.0;  // of the block, along x
    double held = 0.0;                // the point of its top that the tip holds
    bool pushed = false;
    struct Seen {
        double place = 0.0, speed = 0.0;
    };
    std::array<Seen, 80> eyes{};  // what they tell so many ticks late
    for (int i = 0; i < static_cast<int>(seconds / tick); ++i) {
        const double t = i * tick;
        const bool pushes = std::fmod(t, 1.0) >= 0.5;
        if (pushes != pushed) {
            estimate.let_go();
            speed = 0.0;
            eyes.fill({place, 0.0});
            held = place;
            pushed = pushes;
        }
        TipSample sample;
        sample.seconds = tick;
        if (!pushes) {
            const double w = 2.0 * std::numbers::pi * 3.0;
            const double deep = 0.004 + 0.002 * std::sin(w * t), sinking = 0.002 * w * std::cos(w * t);
            const double pressing = std::max(0.0, block.stiffness * deep + block.damping * sinking);
            const double along = place + 0.02 * std::sin(2.0 * std::numbers::pi * 2.0 * t);
            const double most = block.friction * pressing;
            const double dragging = std::clamp(block.stiffness * (along - held), -most, most);
            held = along - dragging / block.stiffness;
            sample.normal = {0.0, 1.0, 0.0};
            sample.tip = {along, -deep, 0.0};
            sample.force = {dragging, -pressing, 0.0};
        } else {
            const double resists = block.on_table * block.mass * g;
            const double push = resists * (1.6 + 0.5 * std::sin(2.0 * std::numbers::pi * 2.5 * t));
            speed = std::max(0.0, speed + tick * (push - resists) / block.mass);
            place += tick * speed;
            sample.normal = {-1.0, 0.0, 0.0};
            sample.tip = {place + push / block.stiffness, 0.0, 0.0};
            sample.force = {push, 0.0, 0.0};
        }
        const Seen seen = std::exchange(eyes[static_cast<std::size_t>(i) % eyes.size()], {place, speed});
        sample.tip += rough(block.place_noise);
        sample.force += rough(block.force_noise);
        sample.body = {seen.place, 0.0, 0.0};
        sample.body_velocity =
            seen.speed > 0.0 ? Vec3(seen.speed, 0.0, 0.0) + rough(block.speed_noise) : Vec3(0.0);
        estimate.feel(sample);
    }
    return estimate;
}

}  // namespace tactus::shared
