#include "core/estimation/touch_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// Samples of a thousand a second err alike over a few ticks: so many count as one.
constexpr double alike = 4.0;

TouchValue told(double value, double deviation, double most) {
    const double within = std::clamp(value, 0.0, most);
    return {within, deviation, value > 0.0 && deviation < 0.2 * within};
}

}  // namespace

TouchEstimate::TouchEstimate(const TouchEstimateSettings& settings)
    : settings_(settings),
      stiffness_({1000.0, 0.0, 0.0}, {settings.max_stiffness, 50.0, 10.0}),
      friction_({0.5}, {1.0}),
      mass_({1.0, 0.0}, {20.0, 50.0}) {}

void TouchEstimate::feel(const TipSample& sample) {
    const double pressing = -glm::dot(sample.force, sample.normal);
    if (!touching_) {
        touching_ = true;
        began_ = sample.tip;
        stretch_ = {0.0, Vec3(0.0), sample.body_velocity, true};
        // The next touch begins elsewhere: where its surface is has to be learnt anew.
        stiffness_.wander({0.0, 0.0, 10.0});
    }
    if (pressing > settings_.least_force) {
        feel_stiffness(sample, pressing);
        feel_friction(sample, pressing);
    }
    feel_mass(sample);
}

void TouchEstimate::let_go() {
    touching_ = false;
}

// How deep is rough, too: k times its chance is as good as a force's.
void TouchEstimate::feel_stiffness(const TipSample& sample, double pressing) {
    const double deep = glm::dot(began_ - sample.tip, sample.normal);
    const double sinking = -glm::dot(sample.tip_velocity, sample.normal);
    const double by_place =
        std::clamp(stiffness_.value(0), 0.0, settings_.max_stiffness) * settings_.place_deviation;
    stiffness_.learn({deep, sinking, 1.0}, pressing, alike * std::hypot(settings_.force_deviation, by_place));
}

// Against the way the tip slides.
void TouchEstimate::feel_friction(const TipSample& sample, double pressing) {
    const Vec3 sliding = sample.tip_velocity - glm::dot(sample.tip_velocity, sample.normal) * sample.normal;
    const double speed = glm::length(sliding);
    if (!(speed > settings_.slides_from)) {
        return;
    }
    // The tip drags what it touches along.
    const double dragging = glm::dot(sample.force, sliding) / speed;
    friction_.wander({1e-4});
    friction_.learn({pressing}, dragging, alike * settings_.force_deviation * (1.0 + friction_.value(0)));
}

void TouchEstimate::feel_mass(const TipSample& sample) {
    stretch_.seconds += sample.seconds;
    stretch_.force += sample.seconds * sample.force;
    stretch_.moves = stretch_.moves && glm::length(sample.body_velocity) > settings_.moves_from;
    if (stretch_.seconds >= settings_.stretch) {
        end_stretch(sample.body_velocity);
        stretch_ = {0.0, Vec3(0.0), sample.body_velocity, true};
    }
}

void TouchEstimate::end_stretch(const Vec3& velocity) {
    const Vec3 mean = 0.5 * (stretch_.velocity + velocity);
    const double speed = glm::length(mean);
    if (!stretch_.moves || !(speed > settings_.moves_from) || glm::dot(stretch_.velocity, velocity) <= 0.0) {
        return;  // it stood still or turned back within: what resists changed with it
    }
    const Vec3 way = mean / speed;
    const double gained = glm::dot(velocity - stretch_.velocity, way) / stretch_.seconds;
    const double force = glm::dot(stretch_.force, way) / stretch_.seconds;
    mass_.learn({force, 1.0}, gained, std::sqrt(2.0) * settings_.speed_deviation / stretch_.seconds);
}

TouchValue TouchEstimate::stiffness() const {
    return told(stiffness_.value(0), stiffness_.deviation(0), settings_.max_stiffness);
}

TouchValue TouchEstimate::friction() const {
    return told(friction_.value(0), friction_.deviation(0), settings_.max_friction);
}

TouchValue TouchEstimate::mass() const {
    const double lightness = std::max(mass_.value(0), 1.0 / settings_.max_mass);
    return told(1.0 / lightness, mass_.deviation(0) / (lightness * lightness), settings_.max_mass);
}

}  // namespace tactus
