#include "core/safety/force_exit.hpp"

#include <algorithm>

#include "core/safety/limited_force.hpp"

namespace tactus {

namespace {

// From the nearest part of `before`.
double farther_than_let_go(const Vec3& force, const Vec3& before) {
    const double squared = glm::dot(before, before);
    const double part = squared > 0.0 ? std::clamp(glm::dot(force, before) / squared, 0.0, 1.0) : 0.0;
    return glm::distance(force, before * part);
}

// No more power than `most` at this velocity: what is along it is left away. Where that would turn the force
// faster than allowed, all of it is shortened.
Vec3 with_less_power(const Vec3& force, const Vec3& before, const Vec3& velocity, double most, double step) {
    const double power = glm::dot(force, velocity);
    const Vec3 aside = force - velocity * ((power - most) / glm::dot(velocity, velocity));
    return farther_than_let_go(aside, before) <= step ? aside : force * (most / power);
}

}  // namespace

Vec3 ForceExit::leave(const ForceLimits& limits, const Vec3& wanted, double most, const Vec3& velocity,
                      double seconds, double own_change, bool& limited) {
    Vec3 force = limited_force(wanted, most);
    const Vec3 change = force - last_;
    const double step = limits.slew * seconds + own_change;
    if (glm::dot(change, change) > step * step) {
        // The limit of size may be another one than a tick ago.
        force = limited_force(last_ + change * (step / glm::length(change)), most);
    }
    given_ = std::max(0.0, given_ - limits.power * seconds);
    const double left = std::max(0.0, limits.energy - given_) / seconds;  // (unit: watts)
    if (glm::dot(force, velocity) > left) {
        force = with_less_power(force, last_, velocity, left, step);
    }
    given_ = std::max(0.0, given_ + glm::dot(force, velocity) * seconds);
    limited = limited || force != wanted;
    last_ = force;
    return force;
}

}  // namespace tactus
