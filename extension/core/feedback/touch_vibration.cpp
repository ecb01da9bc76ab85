#include "core/feedback/touch_vibration.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

namespace tactus {

namespace {

constexpr double tau = 2.0 * std::numbers::pi;

// Of what stops when a fingertip meets a surface; the hand behind it is slower than a tap (unit: kilograms).
constexpr double fingertip_mass = 0.01;

// A surface is not harder than that to a fingertip: its own pad yields (unit: newtons per meter).
constexpr double max_stiffness = 50e3;

// Changes slower than this are felt as force, not as vibration (unit: hertz).
constexpr double slowest_vibration = 20.0;

// Between the two motors of a gamepad (unit: hertz).
constexpr double motor_split = 80.0;

// A ring is e times smaller after one and a half of its periods.
constexpr double decay_a_period = 2.0 / 3.0;

// One-pole low pass: the share of the way to its input that it goes in `seconds`.
double share_of_way(double frequency, double seconds) {
    return -std::expm1(-tau * frequency * seconds);
}

}  // namespace

Tap tap_of(double speed, double stiffness) {
    if (!(speed > 0.0) || !(stiffness > 0.0)) {
        return {};
    }
    const double felt = std::min(stiffness, max_stiffness);
    return {speed * std::sqrt(felt * fingertip_mass), std::sqrt(felt / fingertip_mass) / tau};
}

void Ring::advance(double frequency, double seconds) {
    const double angle = tau * frequency * seconds;
    const double left = std::exp(-decay_a_period * frequency * seconds);
    const double turned = left * (sine * std::cos(angle) + cosine * std::sin(angle));
    cosine = left * (cosine * std::cos(angle) - sine * std::sin(angle));
    sine = turned;
}

// In the second tick of a touch: only two depths tell the speed relative to the surface, which may move.
Tap TouchVibration::begun(const TouchSample& sample, double seconds) const {
    const double deeper = sample.depth - before_.depth;
    return ticks_touched_ == 2 ? tap_of(deeper / seconds, glm::length(sample.force) / sample.depth) : Tap{};
}

double TouchVibration::next(const TouchSample& sample, double seconds) {
    ticks_touched_ = sample.depth > 0.0 ? ticks_touched_ + 1 : 0;
    tap_ = begun(sample, seconds);
    if (tap_.size > 0.0) {
        ring_frequency_ = tap_.frequency;
        ring_.strike(tap_);
    }
    before_ = sample;

    const Vec3 slow_before = slow_;
    slow_ += share_of_way(slowest_vibration, seconds) * (sample.force - slow_);
    fast_ = sample.force - slow_;
    const double size = glm::length(slow_before);
    const double vibration = size > 0.0 ? glm::dot(fast_, slow_before) / size : glm::length(fast_);
    ring_.advance(ring_frequency_, seconds);
    return vibration + ring_.sine;
}

void MotorMeter::add(double vibration, const Vec3& force, double seconds) {
    low_ += share_of_way(motor_split, seconds) * (vibration - low_);
    const double high = vibration - low_;
    low_squares_ += low_ * low_;
    high_squares_ += high * high;
    force_sum_ += glm::length(force);
    ++count_;
}

// A sine of amplitude a has the root mean square a/√2.
MotorLevels MotorMeter::take(const MotorSettings& settings) {
    const MotorMeter seen = std::exchange(*this, MotorMeter{});
    low_ = seen.low_;
    if (seen.count_ == 0) {
        return {};
    }
    const auto level = [&](double squares) {
        return std::sqrt(2.0 * squares / seen.count_) / settings.full_force;
    };
    const double steady = settings.steady_share * seen.force_sum_ / seen.count_ / settings.full_force;
    return {std::min(1.0, level(seen.low_squares_) + steady), std::min(1.0, level(seen.high_squares_))};
}

}  // namespace tactus
