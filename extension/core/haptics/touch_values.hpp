// When two materials feel the same.
#pragma once

#include <algorithm>
#include <memory>
#include <tuple>

#include "core/haptics/touch_material.hpp"

namespace tactus {

// All but the detail, which somebody else owns.
inline bool same_values(const TouchMaterial& a, const TouchMaterial& b) {
    const auto values = [](const TouchMaterial& m) {
        return std::tie(m.stiffness, m.damping, m.static_friction, m.dynamic_friction, m.by_uv,
                        m.texture_size, m.texture_depth, m.magnet_force, m.magnet_range, m.viscosity,
                        m.stick_slip_stiffness, m.stick_slip_force, m.vibration_force, m.vibration_frequency,
                        m.pop_through_force, m.impact_strength, m.impact_frequency, m.impact_decay,
                        m.stribeck_speed, m.stiffening, m.stiffening_depth, m.shaft_friction);
    };
    return values(a) == values(b);
}

// Images are told apart by who they are.
inline bool same_detail(const std::shared_ptr<const TouchDetail>& a,
                        const std::shared_ptr<const TouchDetail>& b) {
    const auto same_surface = [](const std::optional<SurfaceFeel>& p, const std::optional<SurfaceFeel>& q) {
        return p && q ? p->images == q->images && same_values(p->material, q->material)
                      : p.has_value() == q.has_value();
    };
    return a == b ||
           (a && b && a->images == b->images && std::ranges::equal(a->surfaces, b->surfaces, same_surface));
}

}  // namespace tactus
