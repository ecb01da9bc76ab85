#include "core/teleop/parameter_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// What factors of `largest` at most, or its inverse, can add to what a hand and contacts do, along it.
double most_gained(double hand, double contacts, double largest) {
    const auto gained = [largest](double acceleration) {
        return acceleration > 0.0 ? acceleration * (largest - 1.0) : -acceleration * (1.0 - 1.0 / largest);
    };
    return gained(hand) + gained(contacts);
}

}  // namespace

void ParameterEstimate::forget(const EstimateSettings& settings) {
    p_ = q_ = pq_ = 0.0;
    moved_by_hand_ = false;
    pp_ = qq_ = settings.uncertainty * settings.uncertainty;
}

void ParameterEstimate::learn(const EstimateSettings& settings, const MotionLesson& lesson, double share) {
    const Vec3 mean = 0.5 * (lesson.truth_before + lesson.truth);
    const double speed = glm::length(mean);
    moved_by_hand_ = lesson.pushed != Vec3(0.0) || (moved_by_hand_ && speed > settings.slow);
    if (!moved_by_hand_ || !(speed > settings.slow) || !(glm::length(lesson.model) > settings.slow) ||
        !(lesson.seconds > 0.0)) {
        return;
    }
    const Vec3 d = mean / speed;
    const double missing =
        glm::dot((lesson.truth - lesson.truth_before) - (lesson.model - lesson.model_before), d) /
        lesson.seconds;
    const double h = glm::dot(lesson.pushed, d) / lesson.seconds;
    const double c =
        glm::dot(lesson.model - lesson.model_before - lesson.pushed - lesson.fell, d) / lesson.seconds;
    const double wander = settings.wander * settings.wander * lesson.seconds;
    const double most = settings.uncertainty * settings.uncertainty;
    pp_ = std::min(pp_ + wander, most);
    qq_ = std::min(qq_ + wander, most);
    const double doubt = settings.doubt + settings.relative_doubt * (std::abs(h) + std::abs(c));
    if (std::max(missing - most_gained(h, c, settings.largest),
                 -missing - most_gained(-h, -c, settings.largest)) > doubt) {
        return;
    }
    const double a = pp_ * h + pq_ * c;
    const double b = pq_ * h + qq_ * c;
    const double variance = a * h + b * c + doubt * doubt;
    if (!std::isfinite(missing) || !(variance > 0.0) || !std::isfinite(variance)) {
        return;
    }
    const double limit = std::log(settings.largest);
    p_ = std::clamp(p_ + settings.gain * a / variance * missing, -limit, limit);
    q_ = std::clamp(q_ + settings.gain * b / variance * missing, -limit, limit);
    pp_ -= share * a * a / variance;
    pq_ -= share * a * b / variance;
    qq_ -= share * b * b / variance;
}

void ParameterEstimate::take_over_mass(const EstimateSettings& settings, double factor, double deviation) {
    if (!(factor > 0.0) || !(deviation >= 0.0) || !std::isfinite(factor)) {
        return;
    }
    const double limit = std::log(settings.largest);
    p_ = std::clamp(-std::log(factor), -limit, limit);
    pp_ = std::min(deviation * deviation, settings.uncertainty * settings.uncertainty);
    pq_ = 0.0;
}

double ParameterEstimate::mass_factor() const {
    return std::exp(-p_);
}

double ParameterEstimate::friction_factor() const {
    return std::exp(q_);
}

}  // namespace tactus
