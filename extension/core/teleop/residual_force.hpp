// What acts on a body of the far side beyond what the model's physics explains: another hand, a spring, a wall
// that is not described.
//
// From one true state of the body to the next, T later, the model's body began as the true one and gained dv'; of
// that, u came from the residual that the model had then. The true one gained dv. So what acted besides the model,
// as an acceleration, is
//
//     a = (dv - dv' + u) / T
//
// and the estimate r follows it by dr = T / (T + tau) (a - r). An error a - r counts as gravity at most: one blow
// that the model has missed is no force. The variance of the errors says how surely there is a force at all: with n
// independent ones within tau, r is shrunk by 1 - var / (n r^2) (James and Stein 1961). Where nothing more is heard
// the residual decays.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/math/shortened.hpp"
#include "core/teleop/parameter_estimate.hpp"

namespace tactus {

struct ResidualSettings {
    double gain = 1.0;            // of what is found, what the model gets, 0 … 1; 0: none
    double time = 0.1;            // tau (unit: seconds), > 0
    double decay = 0.3;           // without another state (unit: seconds), > 0
    double largest_error = 10.0;  // (unit: meters per second squared), > 0
};

class ResidualForce {
public:
    // `helped`: u, the velocity that the model's body got from the residual (unit: meters per second).
    void learn(const ResidualSettings& settings, const MotionLesson& lesson, const Vec3& helped) {
        const double seconds = lesson.seconds;
        const Vec3 gained = lesson.truth - lesson.truth_before, modelled = lesson.model - lesson.model_before;
        const Vec3 error =
            shortened((gained - modelled + helped) / seconds - mean_, settings.largest_error);
        const double share = seconds / (seconds + settings.time);
        mean_ += share * error;
        variance_ += share * (glm::dot(error, error) - variance_);
        independent_ = 2.0 * settings.time / seconds;
        silent_ = 0.0;
    }
    // Once a tick.
    void tick(const ResidualSettings& settings, double seconds) {
        silent_ += seconds;
        mean_ *= silent_ > settings.time ? 1.0 - seconds / settings.decay : 1.0;
    }
    void forget() { *this = {}; }

    // (unit: meters per second squared)
    Vec3 acceleration(const ResidualSettings& settings) const {
        const double size2 = glm::dot(mean_, mean_);
        const double noise2 = independent_ > 0.0 ? variance_ / independent_ : 0.0;
        return size2 > noise2 ? mean_ * (settings.gain * (1.0 - noise2 / size2)) : Vec3(0.0);
    }

private:
    Vec3 mean_{0.0};
    double variance_ = 0.0;
    double independent_ = 0.0;
    double silent_ = 0.0;  // since the last state (unit: seconds)
};

}  // namespace tactus
