// Friction that falls with the speed (Stribeck): from static at rest to dynamic at a few times the speed v_s,
//     mu(v) = mu_d + (mu_s - mu_d) exp(-(v / v_s)^2).
//
// A proxy has no mass: where friction falls it slides on at once, by p |d mu| (p: the penetration, the
// normal force over the stiffness), and in a tick of dt that is a speed of p |mu'| / dt times the change of
// speed that has caused it: 30 times, for a fall of 0.3 within 0.05 m/s at 5 mm. So the speed that friction
// goes by, w, follows the proxy's v within a time of its own, as it does between real surfaces (Hess and Soom
// 1990):
//     w' = w + (v - w) dt / tau
// With g = p |mu'|, v changes by g (w - w_before) / dt: around a steady pace
//     w'' - (1 - dt/tau + g/tau) w' + (g/tau) w = 0
// which is stable if and only if g < tau. tau = 2 max(g, dt), with the steepest mu', is stable at every speed
// and depth; at a steady pace w is v, and friction that of the law. Coefficients are never below 0, so that
// friction only ever takes.
#pragma once

#include <cmath>

#include "core/haptics/touch_material.hpp"

namespace tactus {

// Coulomb's coefficient. `speed`: w (unit: meters per second). Without a speed v_s, static until it slides.
inline double friction_at(const TouchMaterial& material, bool sliding, double speed) {
    if (material.stribeck_speed <= 0.0) {
        return sliding ? material.dynamic_friction : material.static_friction;
    }
    const double ratio = speed / material.stribeck_speed;
    return material.dynamic_friction +
           (material.static_friction - material.dynamic_friction) * std::exp(-ratio * ratio);
}

// The steepest fall: (mu_s - mu_d) sqrt(2 / e) / v_s, at v_s / sqrt(2) (unit: seconds per meter).
inline double steepest_fall(const TouchMaterial& material) {
    constexpr double sqrt_two_over_e = 0.857763884960707;
    return material.stribeck_speed > 0.0
               ? sqrt_two_over_e * std::abs(material.static_friction - material.dynamic_friction) /
                     material.stribeck_speed
               : 0.0;
}

}  // namespace tactus
