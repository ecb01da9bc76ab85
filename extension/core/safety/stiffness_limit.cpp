#include "core/safety/stiffness_limit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tactus {

Wall safe_wall(const LoopLag& lag, double device_damping, const Wall& wanted) {
    const double damping = std::min(wanted.damping, 0.25 * device_damping);
    const double stiffest = (device_damping - damping) / (lag.delay + 0.5 * lag.seconds);
    return {std::min(wanted.stiffness, stiffest), damping};
}

double damping_needed(double stiffness, const LoopLag& lag) {
    return stiffness * (lag.delay + 0.5 * lag.seconds);
}

std::string explain_stiffness(double wanted, double used, const LoopLag& lag) {
    if (!(used < wanted)) {
        return {};
    }
    char text[120];
    std::snprintf(text, sizeof text, "%.0f N/m is unsafe at %.3g ms: %.0f N/m used", wanted,
                  1e3 * (lag.delay > 0.0 ? lag.delay : lag.seconds), std::floor(used));
    return text;
}

}  // namespace tactus
