#include "core/haptics/hand_effect.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tactus {

namespace {

using EffectForm = HandEffect::Form;

constexpr double effect_turn = 2.0 * std::numbers::pi;

// More is no force of a device that a hand holds (unit: newtons).
constexpr double strongest_effect = 1e6;

bool is_effect_size(double value) {
    return value >= 0.0 && value <= strongest_effect;
}

bool is_effect_vector(const Vec3& v) {
    return std::isfinite(v.x + v.y + v.z);
}

Vec3 effect_friction(const HandEffect& effect, const Vec3& hand, Vec3& anchor) {
    const Vec3 stretched = hand - anchor;
    const double length = glm::length(stretched);
    const double longest = effect.force / effect.stiffness;
    if (length > longest) {
        anchor = hand - stretched * (longest / length);
    }
    return -effect.stiffness * (hand - anchor);
}

Vec3 effect_wall(const HandEffect& effect, const HandMotion& hand) {
    const double depth = glm::dot(effect.place - hand.position, effect.direction);
    if (depth <= 0.0) {
        return Vec3(0.0);
    }
    const double speed = glm::dot(hand.velocity, effect.direction);
    return std::max(0.0, effect.stiffness * depth - effect.damping * speed) * effect.direction;
}

}  // namespace

std::string check_effect(const HandEffect& effect) {
    if (!is_effect_vector(effect.place) ||
        (has_direction(effect.form) && !(std::abs(glm::length(effect.direction) - 1.0) < 1e-6))) {
        return "its place or its direction is none: give finite numbers, and a direction that is not zero";
    }
    if (!is_effect_size(std::abs(effect.force)) || !is_effect_size(std::abs(effect.first_force)) ||
        !is_effect_size(effect.stiffness) || !is_effect_size(effect.damping) ||
        !std::isfinite(effect.phase)) {
        return "its force, stiffness or damping is none: give numbers between 0 and 1,000,000";
    }
    if (effect.form == EffectForm::friction && !(effect.stiffness > 0.0 && effect.force >= 0.0)) {
        return "friction without a stiffness, or with a force below zero, holds nothing: raise it";
    }
    if (!(effect.period > 0.0 && effect.duration > 0.0 && effect.pitch > 0.0)) {
        return "its period, duration or pitch is not above zero: raise it";
    }
    return "";
}

Wall steepest(const HandEffect& effect) {
    switch (effect.form) {
        case EffectForm::spring:
        case EffectForm::friction:
            return {effect.stiffness, 0.0};
        case EffectForm::damper:
            return {0.0, effect.damping};
        case EffectForm::detent:
            return {effect_turn * std::abs(effect.force) / effect.pitch, 0.0};
        case EffectForm::wall:
            return {effect.stiffness, effect.damping};
        default:
            return {};
    }
}

HandEffect weakened(HandEffect effect, double stiffness_share, double damping_share) {
    effect.stiffness *= stiffness_share;
    effect.damping *= damping_share;
    effect.force *= effect.form == EffectForm::detent ? stiffness_share : 1.0;
    return effect;
}

Vec3 effect_force(const HandEffect& effect, const HandMotion& hand, Nanoseconds now,
                  HandEffectMemory& memory) {
    if (memory.form != effect.form) {
        memory = {effect.form, now, hand.position};
    }
    const double time = to_seconds(now - memory.since);
    const Vec3& u = effect.direction;
    switch (effect.form) {
        case EffectForm::constant:
            return effect.force * u;
        case EffectForm::spring:
            return -effect.stiffness * (hand.position - effect.place);
        case EffectForm::damper:
            return -effect.damping * hand.velocity;
        case EffectForm::friction:
            return effect.stiffness > 0.0 ? effect_friction(effect, hand.position, memory.anchor) : Vec3(0.0);
        case EffectForm::sine:
            return effect.force * std::sin(effect_turn * time / effect.period + effect.phase) * u;
        case EffectForm::ramp:
            return (effect.first_force +
                    (effect.force - effect.first_force) * std::min(time / effect.duration, 1.0)) *
                   u;
        case EffectForm::detent:
            return -effect.force *
                   std::sin(effect_turn * glm::dot(hand.position - effect.place, u) / effect.pitch) * u;
        case EffectForm::wall:
            return effect_wall(effect, hand);
        default:
            return Vec3(0.0);
    }
}

}  // namespace tactus
