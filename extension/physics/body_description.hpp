// Everything of an ordinary rigid body that its motion depends on, as plain values.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/shape.hpp"
#include "core/math/pose.hpp"

namespace tactus {

enum class Motion {
    Static,     // never moves by itself
    Kinematic,  // moves as told, pushes others, is not pushed
    Dynamic,    // moved by forces and contacts
};

// How a surface meets another one. Two bodies combine as Godot's own physics combines them:
//   friction    = the smaller of the two, but a rough body's friction wins over that of one that is not rough
//                 (of two rough ones the larger);
//   restitution = the sum clamped to 0..1, where an absorbent body subtracts instead of adding.
struct SurfaceMaterial {
    double friction = 1.0;     // Coulomb coefficient (dimensionless), >= 0
    double restitution = 0.0;  // share of the approach speed that comes back (dimensionless), 0..1
    bool rough = false;
    bool absorbent = false;
};

// What a body turned out to be, as factors of how it was described.
struct BodyFactors {
    double mass = 1.0;      // of its mass and inertia (dimensionless), > 0
    double friction = 1.0;  // of the friction between it and any other body (dimensionless), >= 0
    friend bool operator==(const BodyFactors&, const BodyFactors&) = default;
};

// A collides with B when A's mask holds a layer of B or B's mask a layer of A. A dynamic body whose own mask
// does not hold the other's layers pushes it without being pushed, as in Godot.
struct CollisionLayers {
    std::uint32_t layer = 1;  // bit i: the body is in layer i + 1
    std::uint32_t mask = 1;   // bit i: the body notices layer i + 1
};

struct BodyDescription {
    std::vector<PlacedShape> shapes;  // in the body's frame; several make a compound
    Pose pose;                        // of the body in the world
    Motion motion = Motion::Dynamic;

    // A static body that may be unfrozen later keeps what a moving one needs.
    bool may_move = false;

    double mass = 1.0;                   // (unit: kilograms), > 0; ignored for static bodies that never move
    std::optional<Vec3> center_of_mass;  // in the body's frame (unit: meters); absent: that of the shapes
    std::optional<Vec3> inertia;  // about the centre of mass along the body's axes (unit: kilogram square
                                  // meters), > 0; absent: that of the shapes, filled evenly

    SurfaceMaterial material;
    double linear_damping = 0.0;   // dv/dt = -c v (unit: 1/seconds), >= 0
    double angular_damping = 0.0;  // dw/dt = -c w (unit: 1/seconds), >= 0
    double gravity_scale = 1.0;    // factor on the world's gravity (dimensionless)

    Vec3 linear_velocity{0.0};   // of the centre of mass, in the world (unit: meters per second)
    Vec3 angular_velocity{0.0};  // in the world (unit: radians per second)

    CollisionLayers collision;
    bool continuous = false;  // sweep the body along its way, so that a fast one cannot pass a thin one
    bool can_sleep = true;    // while it is dynamic

    // Axes of the world along and about which the body may not move: x, y, z.
    bool lock_linear[3] = {false, false, false};
    bool lock_angular[3] = {false, false, false};
};

}  // namespace tactus
