// From what was true at the far side, one delay ago, to what is true now (thesis 3.1.4).
#pragma once

#include <cstdint>

#include "core/math/body_motion.hpp"

namespace tactus {

enum class Derivation : std::uint8_t {
    none,          // what was true is taken for the present: the model lags behind (thesis figure 3.4)
    velocity,      // eq. 3.1: x(t) = x_r + x'_r dt
    acceleration,  // x(t) = x_r + x'_r dt + x''_r dt^2 / 2
    averaged,      // eq. 3.1 with the mean of the far side's rate and the model's own then; the former stays
    history,       // what changed in the model since that sample is applied to the truth
    resimulate,    // the truth is put into the model's past, and what the hand did since is replayed
};

struct DerivationInput {
    BodyMotion received;             // true at the far side after operator sample n
    BodyMotion own_then;             // the model after operator sample n
    BodyMotion own_now;              // the model now
    double seconds = 0.0;            // from then to now, >= 0
    Vec3 linear_acceleration{0.0};   // of the far side then (unit: meters per second squared)
    Vec3 angular_acceleration{0.0};  // (unit: radians per second squared)
    double max_extrapolation = 0.5;  // rates are believed for so long (unit: seconds), >= 0
};

// The present state that `received` leads to. Re-simulation is no formula: for it, this is `history`, which
// stands in where the past is not known far enough back.
BodyMotion derive(Derivation derivation, const DerivationInput& input);

}  // namespace tactus
