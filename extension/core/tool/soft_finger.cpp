#include "core/tool/soft_finger.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tactus {

namespace {

// A turn in one tick that is none: 0.1 degrees in a second of 1,000 ticks (unit: radians).
constexpr double still = 0.001 * Torsion::break_away;

// Normals of one contact in two ticks are closer than 45 degrees.
constexpr double same_normal = 0.7;

}  // namespace

double patch_radius(const SoftFinger& finger, double pressing) {
    return std::cbrt(0.75 * pressing * finger.radius / finger.modulus);
}

double torsion_limit(const SoftFinger& finger, double friction, double pressing, double along) {
    const double max_along = friction * pressing;
    if (!finger.is_soft() || !(max_along > 0.0)) {
        return 0.0;
    }
    const double used = std::min(1.0, along / max_along);
    const double left = (1.0 - 0.25 * used * used) * std::sqrt(1.0 - used * used);
    return 3.0 * std::numbers::pi / 16.0 * max_along * patch_radius(finger, pressing) * left;
}

void turn_in_grip(Torsion& torsion, const TorsionLimits& limits, double turned) {
    const double before = torsion.stiffness;
    torsion.stiffness = std::max(before, limits.at_rest / Torsion::break_away);
    if (!(torsion.stiffness > 0.0)) {
        torsion.twist = torsion.limit = 0.0;
        return;
    }
    torsion.twist = torsion.twist * (before / torsion.stiffness) + turned;
    const double held = torsion.stiffness * std::abs(torsion.twist);
    const bool goes_on = torsion.slips && turned * torsion.twist > 0.0 && std::abs(turned) > still;
    torsion.slips = held > (goes_on ? limits.slipping : limits.at_rest);
    torsion.limit = torsion.slips ? limits.slipping : limits.at_rest;
    const double farthest = torsion.limit / torsion.stiffness;
    torsion.twist = std::clamp(torsion.twist, -farthest, farthest);
}

Torsion TorsionList::grip_of(int body, const Vec3& normal) const {
    Torsion found;
    double nearest = same_normal;
    for (int i = 0; i < count; ++i) {
        const Torsion& torsion = items[static_cast<std::size_t>(i)];
        if (torsion.body == body && glm::dot(torsion.normal, normal) > nearest) {
            nearest = glm::dot(torsion.normal, normal);
            found = torsion;
        }
    }
    found.body = body;
    found.normal = normal;
    return found;
}

}  // namespace tactus
