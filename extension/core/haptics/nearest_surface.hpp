// Where a body's surface is nearest to a point: for what reaches out to the proxy without touching it.
#pragma once

#include "core/haptics/touch_scene.hpp"

namespace tactus {

struct NearestSurface {
    double distance = 0.0;       // negative inside a solid; `far` where nothing is nearer (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};  // unit, from the surface to the point, in the world
    bool complete = true;        // false: the budget ended the search
};

// Looks at one body, up to the distance `far`. Where the budget ends the search, the answer is not complete:
// a nearer place may exist.
NearestSurface nearest_surface(const TouchScene& scene, int body, const Vec3& point, double far,
                               WorkBudget& work);
NearestSurface nearest_surface(const TouchScene& scene, int body, const Vec3& point, double far);

}  // namespace tactus
