// What a surface feels like.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/haptics/force_curve.hpp"

namespace tactus {

// Values between 0 and 1 over a square that repeats in both directions: values[row * columns + column].
struct TouchImage {
    std::uint32_t columns = 0;  // >= 1
    std::uint32_t rows = 0;     // >= 1
    std::vector<float> values;
};

struct TouchImages {
    std::shared_ptr<const TouchImage> heights;   // of the relief; null: it has none
    std::shared_ptr<const TouchImage> friction;  // share of both coefficients; null: all of them
    std::shared_ptr<const ForceCurve> curve{};   // in place of a stiffness; null: it has none

    bool operator==(const TouchImages&) const = default;
};

struct TouchDetail;

struct TouchMaterial {
    double stiffness = 500.0;  // force per penetration (unit: newtons per meter), >= 0
    double damping = 0.0;      // against the speed into the surface (unit: newton-seconds per meter), >= 0
    double static_friction = 0.0;   // Coulomb coefficient at rest, >= dynamic_friction
    double dynamic_friction = 0.0;  // Coulomb coefficient while sliding, >= 0
    // Within which friction falls from static to dynamic, see friction.hpp; 0: it does so at once, where it
    // begins to slide (unit: meters per second), >= 0
    double stribeck_speed = 0.0;
    // So many times as stiff at this depth and below, see surface_spring.hpp; 1: everywhere alike.
    double stiffening = 1.0;          // (dimensionless), > 0
    double stiffening_depth = 0.005;  // (unit: meters), > 0

    // Effects; each is off where its force, depth or coefficient is 0 (surface_effects.hpp).
    const TouchDetail* detail = nullptr;  // not owned; null: neither images nor surfaces of their own
    bool by_uv = false;                   // images lie as the mesh's texture coordinates say, see SurfaceMap
    double texture_size = 0.05;           // side of one repetition on the surface (unit: meters), > 0
    double texture_depth = 0.0;           // from height 0 to height 1 (unit: meters), >= 0
    double magnet_force = 0.0;            // pull towards the surface while touching it (unit: newtons), >= 0
    double magnet_range = 0.01;           // gap at which the pull has faded to nothing (unit: meters), > 0
    double viscosity = 0.0;               // drag along the surface, and within it where it has broken
                                          // (unit: newton-seconds per meter), >= 0
    double stick_slip_stiffness =
        0.0;                        // of the spring to where the hand sticks (unit: newtons per meter), >= 0
    double stick_slip_force = 0.0;  // at which it slips (unit: newtons), >= 0
    double vibration_force = 0.0;   // amplitude along the normal (unit: newtons), >= 0
    double vibration_frequency = 0.0;  // (unit: hertz), 0 to half the tick rate
    double pop_through_force = 0.0;    // that breaks the surface; 0: nothing does (unit: newtons), >= 0
    // Of a tap, by the speed into the surface that it begins with (unit: newton-seconds per meter), >= 0.
    double impact_strength = 0.0;
    double impact_frequency = 200.0;  // (unit: hertz), 0 to half the tick rate
    double impact_decay = 0.02;       // in which it falls to 1 / e (unit: seconds), > 0
    // Of a body whose surface has broken, by the length within it: what a needle's shaft sticks with (unit:
    // newtons per meter), >= 0.
    double shaft_friction = 0.0;
};

// What one surface of a mesh feels like.
struct SurfaceFeel {
    TouchMaterial material;
    TouchImages images;
};

// What a body's material has besides its values.
struct TouchDetail {
    TouchImages images;
    std::vector<std::optional<SurfaceFeel>> surfaces;  // of its mesh; none, or beyond: as the body
};

}  // namespace tactus
