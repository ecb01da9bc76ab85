// When two materials feel the same.
#pragma once

#include <tuple>

#include "core/haptics/touch_material.hpp"

namespace tactus {

// All but the texture's heights, which somebody else owns.
inline bool same_values(const TouchMaterial& a, const TouchMaterial& b) {
    const auto values = [](const TouchMaterial& m) {
        return std::tie(m.stiffness, m.damping, m.static_friction, m.dynamic_friction, m.texture_size,
                        m.texture_depth, m.magnet_force, m.magnet_range, m.viscosity, m.stick_slip_stiffness,
                        m.stick_slip_force, m.vibration_force, m.vibration_frequency, m.pop_through_force,
                        m.impact_strength, m.impact_frequency, m.impact_decay, m.stribeck_speed, m.stiffening,
                        m.stiffening_depth);
    };
    return values(a) == values(b);
}

}  // namespace tactus
