#include "core/teleop/control_scheme.hpp"

#include <glm/geometric.hpp>

namespace tactus {

namespace {

// Below this nothing is pressed, and a force has no direction (unit: newtons).
constexpr double no_force = 1e-4;

Vec3 approached(const Vec3& from, const Vec3& to, double way) {
    const double length = glm::length(to - from);
    return length <= way ? to : from + (to - from) * (way / length);
}

// As deep below the proxy as the force asks for, F = k (x_proxy - x_hand); across the force where `place` is.
Vec3 pressing(const StandInSettings& settings, const StandInInput& in, const Vec3& place) {
    const double size = glm::length(in.force);
    if (!in.in_contact || size < no_force || !(in.stiffness > 0.0)) {
        return place;
    }
    const Vec3 n = in.force / size;
    const Vec3 pressed = place + n * (glm::dot(in.own_proxy - place, n) - size / in.stiffness);
    return approached(place, pressed, settings.leash);
}

}  // namespace

Vec3 stand_in_hand(ControlScheme scheme, const StandInSettings& settings, const StandInInput& in) {
    switch (scheme) {
        case ControlScheme::spring:
            return in.hand;
        case ControlScheme::position:
            return in.in_contact ? in.hand : approached(in.own_hand, in.hand, settings.speed * in.seconds);
        case ControlScheme::position_force:
            return pressing(settings, in, in.hand);
        case ControlScheme::position_force_relative:
            return pressing(settings, in,
                            in.relative
                                ? approached(in.hand, to_parent(in.object, *in.relative), settings.leash)
                                : in.hand);
    }
    return in.hand;
}

}  // namespace tactus
