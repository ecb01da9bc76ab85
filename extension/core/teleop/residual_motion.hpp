// What acts on a body of the far side beyond what the model's physics explains: another operator's hand, a
// spring, a wall that is not described.
//
// From one state of the far side's body to the next, T later, the model's body began as the first says and
// gained dv' under the same hand, without its residual. The far side's gained dv. The rest,
//
//     a = (dv - dv') / T
//
// is what else acted. The estimate r follows a with a time constant tau. An error a - r counts as
// `largest_error` at most: one missed blow is no force. With n independent errors within tau, r is shrunk by
// 1 - (var / n + least^2) / |r|^2 (James and Stein 1961); `least` is what rounding and the timing of states
// may look like. Where the states confirm r, it fades: friction that holds a
// body at rest would else keep a residual that is no more. It fades, too, where no states come.
//
// The model's body gets along n = r / |r|, in each tick of length dt, the velocity
//
//     clamp(|r| dt + min(w, 0) - v . n, 0, (1 + margin) |r| dt)
//
// with w the far body's velocity along n in its last state. So a support that holds a body also holds it
// against a harder push, and hardly moves a body that is released: a wall springs back for a moment only.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/shortened.hpp"

namespace tactus {

struct ResidualSettings {
    double gain = 1.0;            // of what is found, the model's share, 0 … 1; 0: none
    double time = 0.1;            // tau (unit: seconds), > 0
    double fade = 1.0;            // of what the states confirm (unit: seconds), > 0
    double silence = 0.3;         // without a state for so long it fades within as much (unit: seconds), > 0
    double margin = 0.5;          // more than |r| that holds a body back (share of |r|), >= 0
    double least = 2.0;           // (unit: meters per second squared), >= 0
    double least_turn = 40.0;     // (unit: radians per second squared), >= 0
    double largest_error = 20.0;  // (unit: meters per second squared), > 0
    double largest = 100.0;       // |r| (unit: meters per second squared), > 0
    double largest_turn_error = 400.0;  // (unit: radians per second squared), > 0
    double largest_turn = 2000.0;       // (unit: radians per second squared), > 0
};

// Acts on one velocity of the model's body, the linear or the angular one.
struct Residual {
    Vec3 acceleration{0.0};  // r
    double speed = 0.0;      // min(w, 0)
    double margin = 0.0;

    bool operator==(const Residual&) const = default;
};

// The velocity that a body of velocity `velocity` gets within `seconds`.
inline Vec3 residual_step(const Residual& residual, const Vec3& velocity, double seconds) {
    const double size = glm::length(residual.acceleration);
    if (!(size > 0.0)) {
        return Vec3(0.0);
    }
    const Vec3 n = residual.acceleration / size;
    const double wanted = size * seconds + residual.speed - glm::dot(velocity, n);
    return n * std::clamp(wanted, 0.0, (1.0 + residual.margin) * size * seconds);
}

class ResidualMotion {
public:
    // Of a linear or an angular velocity: `truth` gained at the far side, `model` in the model.
    struct Lesson {
        Vec3 truth{0.0}, model{0.0};
        double seconds = 0.0;  // > 0
    };

    void learn(const ResidualSettings& settings, const Lesson& lesson, double largest_error, double largest) {
        const Vec3 acts = (lesson.truth - lesson.model) / lesson.seconds;
        const Vec3 error = shortened(acts - mean_, largest_error);
        const double share = lesson.seconds / (lesson.seconds + settings.time);
        const bool is_confirmed = glm::dot(error, mean_) <= confirmed * glm::dot(mean_, mean_);
        mean_ = shortened(mean_ + share * error, largest);
        mean_ *= is_confirmed ? std::max(0.0, 1.0 - lesson.seconds / settings.fade) : 1.0;
        variance_ += share * (glm::dot(error, error) - variance_);
        independent_ = 1.0 + 2.0 * settings.time / lesson.seconds;
        silent_ = 0.0;
    }
    // Once a tick.
    void tick(const ResidualSettings& settings, double seconds) {
        silent_ += seconds;
        if (silent_ > settings.silence) {
            mean_ *= std::max(0.0, 1.0 - seconds / settings.silence);
        }
    }
    void forget() { *this = {}; }

    // `velocity`: of the far side's body in its last state.
    Residual residual(const ResidualSettings& settings, const Vec3& velocity, double least) const {
        const double size2 = glm::dot(mean_, mean_);
        const double noise2 = least * least + (independent_ > 0.0 ? variance_ / independent_ : 0.0);
        if (!(size2 > noise2)) {
            return {};
        }
        const Vec3 acceleration = mean_ * (settings.gain * (1.0 - noise2 / size2));
        const Vec3 n = mean_ / std::sqrt(size2);
        return {acceleration, std::min(glm::dot(velocity, n), 0.0), settings.margin};
    }

private:
    static constexpr double confirmed = 0.02;  // an error of no more along r (share of |r|)

    Vec3 mean_{0.0};  // r
    double variance_ = 0.0;
    double independent_ = 0.0;
    double silent_ = 0.0;  // since the last lesson (unit: seconds)
};

}  // namespace tactus
