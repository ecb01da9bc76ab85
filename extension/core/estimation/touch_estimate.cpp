#include "core/estimation/touch_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace tactus {

namespace {

// As soft as anything that a robot can feel for (unit: newtons per meter).
constexpr double softest = 50.0;

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

double TouchEstimate::spring() const {
    return std::clamp(stiffness_.value(0), softest, settings_.max_stiffness);
}

void TouchEstimate::feel(const TipSample& sample) {
    const double pressing = -glm::dot(sample.force, sample.normal);
    follow_tip(sample);
    const bool rests = sample.body_velocity == Vec3(0.0) && sample.body_turning == Vec3(0.0);
    if (!rests) {
        touching_ = false;
        felt_count_ = 0;
    } else if (std::isfinite(pressing) && std::isfinite(glm::dot(sample.tip, sample.tip))) {
        feel_surface(sample, pressing);
    }
    feel_mass(sample, pressing);
}

void TouchEstimate::follow_tip(const TipSample& sample) {
    const double share = has_tip_ ? sample.seconds / (sample.seconds + settings_.lag) : 1.0;
    late_tip_ += share * (sample.tip - late_tip_);
    has_tip_ = true;
}

void TouchEstimate::let_go() {
    touching_ = has_tip_ = false;
    felt_count_ = 0;
    pushed_ = 0.0;
    pushes_.fill({});
}

void TouchEstimate::feel_surface(const TipSample& sample, double pressing) {
    const Vec3 tip = late_tip_ - sample.body;
    if (!touching_) {
        touching_ = true;
        began_ = tip_ = tip;
        force_ = sample.force;
        held_ = tip - sample.force / spring();
        deep_ = 0.0;
        felt_count_ = 0;
        // The next touch begins elsewhere: where its surface is has to be learnt anew.
        stiffness_.wander({0.0, 0.0, 10.0});
    }
    if (felt_count_ >= late) {
        learn(felt_[felt_count_ % late], sample.seconds);
    }
    Felt& felt = felt_[felt_count_++ % late];
    felt.deep = glm::dot(began_ - tip, sample.normal);
    felt.sinking = (felt.deep - std::exchange(deep_, felt.deep)) / sample.seconds;
    felt.pressing = pressing;
    const double share = sample.seconds / (sample.seconds + settings_.smoothing);
    tip_ += share * (tip - tip_);
    force_ += share * (sample.force - force_);
    const double slid = slide(tip_ - force_ / spring(), sample.normal);
    felt.slides = slid > settings_.slides_from * sample.seconds && slid_ > slack();
    felt.dragging = glm::dot(force_, way_);
    felt.pressed = -glm::dot(force_, sample.normal);
}

// How far p slides in this tick. The point that is held is dragged along behind p, at the length of the
// slack; the way of that is smoothed, too: chance across it would shorten what is felt along it.
double TouchEstimate::slide(const Vec3& place, const Vec3& normal) {
    const Vec3 off = place - held_;
    const Vec3 along = off - glm::dot(off, normal) * normal;
    const double length = glm::length(along);
    if (!(length > slack())) {
        return 0.0;
    }
    const Vec3 way = along / length;
    const double slid = length - slack();
    held_ += slid * way;
    const bool goes_on = glm::dot(way, way_) > 0.0;
    slid_ = goes_on ? slid_ + slid : slid;
    way_ = goes_on ? glm::normalize(way_ + std::min(1.0, slid / slack()) * (way - way_)) : way;
    return slid;
}

double TouchEstimate::slack() const {
    return settings_.slack + 2.0 * settings_.force_deviation / spring();
}

// How deep is rough, too: k times its chance is as good as a force's.
void TouchEstimate::learn(const Felt& felt, double tick) {
    if (!(felt.pressing > settings_.least_force)) {
        return;
    }
    const double alike = std::sqrt(settings_.alike / tick);
    const double rough = std::hypot(settings_.force_deviation, spring() * settings_.place_deviation);
    stiffness_.learn({felt.deep, felt.sinking, 1.0}, felt.pressing, alike * rough);
    // Friction drives nothing: what turns round gives way more or less than straight down.
    if (felt.slides && felt.dragging > 0.0) {
        friction_.wander({1e-4});
        friction_.learn({felt.pressed}, felt.dragging,
                        alike * settings_.force_deviation * (1.0 + friction_.value(0)));
    }
}

void TouchEstimate::feel_mass(const TipSample& sample, double pressing) {
    pushed_ += sample.seconds / (sample.seconds + settings_.smoothing) * (pressing - pushed_);
    const bool is_pushed = pushed_ > settings_.least_force && stiffness().known &&
                           glm::length(sample.body_turning) < settings_.turns_from;
    if (!is_pushed) {
        pushes_.fill({});
        return;
    }
    if (pushes_[0].seconds < 0.0) {
        pushes_[0].seconds = 0.0;
        pushes_[1].seconds = -0.5 * settings_.stretch;
    }
    for (Push& push : pushes_) {
        follow(push, sample, pressing);
    }
}

void TouchEstimate::follow(Push& push, const TipSample& sample, double pressing) {
    const double tick = sample.seconds, stretch = settings_.stretch;
    const Vec3 place = late_tip_ - sample.force / spring();
    if (push.seconds <= 0.0 && push.seconds + tick > 0.0) {
        push = {.seconds = push.seconds, .way = -sample.normal, .from = place};
    }
    push.seconds += tick;
    if (push.seconds <= 0.0) {
        return;
    }
    const double s = (push.seconds - 0.5 * tick) / stretch;
    const double gone = glm::dot(place - push.from, push.way);
    push.forces += tick * pressing * 30.0 * s * s * (1.0 - s) * (1.0 - s) / stretch;
    push.places += tick * gone * 60.0 * (1.0 - 6.0 * s + 6.0 * s * s) / (stretch * stretch * stretch);
    if (push.seconds * parts < stretch * static_cast<double>(push.part + 1)) {
        return;
    }
    if (!(gone - push.gone > settings_.moves_from * stretch / parts)) {
        // It stood still within: what resists changed with it.
        push = {.seconds = &push == pushes_.data() ? 0.0 : -0.5 * stretch};
        return;
    }
    push.gone = gone;
    if (++push.part == parts) {
        end(push);
        push = {.seconds = 0.0};
    }
}

// Of the integral of w'' p, chance alone: the square of w'' has the integral 720 / T^5.
void TouchEstimate::end(const Push& push) {
    const double rough = std::hypot(settings_.place_deviation, settings_.force_deviation / spring());
    const double chance = rough * std::sqrt(720.0 * settings_.alike / std::pow(settings_.stretch, 5.0));
    // Every moment lies in two stretches.
    mass_.learn({push.forces, 1.0}, push.places, std::sqrt(2.0) * chance);
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
