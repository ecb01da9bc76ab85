// A place where the proxy touches, or nearly touches, a surface.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

struct Contact {
    Vec3 point{0.0};                      // on the surface, in the world (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};           // unit, from the surface to the proxy's centre, in the world
    Vec3 force_direction{0.0, 1.0, 0.0};  // unit; the normal, or what force shading makes of it, in the world
    double gap = 0.0;  // distance still to the resting distance radius + skin (unit: meters)
    // How the distance bends with the proxy's place: second derivatives along u and cross(normal, u) (unit:
    // 1/meter).
    Vec3 u{1.0, 0.0, 0.0};
    double bend_u = 0.0;
    double bend_v = 0.0;
    Vec3 pivot{
        0.0};       // centre of the curvature bend_u, in the world (unit: meters); meaningless where it is 0
    int body = -1;  // slot in the TouchScene
    double pressure =
        0.0;  // penetration this contact holds back: the force over the stiffness (unit: meters)
};

}  // namespace tactus
