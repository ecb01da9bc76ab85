// The torque of a soft finger's patch the slow way, piece by piece: what core/tool is held against.
#pragma once

#include "core/tool/soft_finger.hpp"

namespace tactus::shared {

// Coulomb's torque of a patch under Hertz's pressure, ring by ring (unit: newton meters).
double slow_torsion(const SoftFinger& finger, double friction, double pressing);

// The largest torque of that patch about its middle while it carries a force along the surface, from turns
// about all points (unit: newton meters).
double slow_torsion(const SoftFinger& finger, double friction, double pressing, double along);

}  // namespace tactus::shared
