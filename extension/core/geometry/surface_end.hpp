// How far a piece of a surface goes. The distance to an edge bends with the radius of the distance itself,
// but only until a face takes over: on a fine mesh that is a very short way.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

// A point that moves by m leaves the piece its distance is measured to as soon as dot(direction, m) > room.
struct SurfaceEnd {
    Vec3 direction;  // of any length
    double room;     // (unit: meters times that length), >= 0
};

}  // namespace tactus
