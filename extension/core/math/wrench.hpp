// A force with the torque that goes with it.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

struct Wrench {
    Vec3 force{0.0};   // (unit: newtons)
    Vec3 torque{0.0};  // about a place that is said elsewhere (unit: newton meters)

    friend bool operator==(const Wrench&, const Wrench&) = default;
};

}  // namespace tactus
