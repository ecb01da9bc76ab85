#include "core/teleop/force_exit.hpp"

#include <algorithm>

#include "core/haptics/force_law.hpp"

namespace tactus {

Vec3 ForceExit::leave(const ForceLimits& limits, const Vec3& wanted, double most, const Vec3& velocity,
                      double seconds, double own_change, bool& limited) {
    Vec3 force = limited_force(wanted, most);
    const Vec3 change = force - last_;
    const double step = limits.slew * seconds + own_change;
    if (glm::dot(change, change) > step * step) {
        force = last_ + change * (step / glm::length(change));
    }
    const double power = glm::dot(force, velocity);
    given_ = std::max(0.0, given_ - limits.power * seconds);
    if (given_ + power * seconds > limits.energy) {
        // No more of what helps the hand along than is left.
        const double left = std::max(0.0, limits.energy - given_) / seconds;
        force -= velocity * ((power - left) / glm::dot(velocity, velocity));
    }
    given_ = std::max(0.0, given_ + glm::dot(force, velocity) * seconds);
    limited = limited || force != wanted;
    last_ = force;
    return force;
}

}  // namespace tactus
