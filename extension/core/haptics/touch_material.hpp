// What a surface feels like.
#pragma once

namespace tactus {

struct TouchMaterial {
    double stiffness = 500.0;       // force per penetration (unit: newtons per meter), >= 0
    double damping = 0.0;           // against the speed into the surface (unit: newton-seconds per meter), >= 0
    double static_friction = 0.0;   // Coulomb coefficient at rest, >= dynamic_friction
    double dynamic_friction = 0.0;  // Coulomb coefficient while sliding, >= 0
};

}  // namespace tactus
