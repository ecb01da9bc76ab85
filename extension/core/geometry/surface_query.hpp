// Questions about the surfaces of bodies beside those of the proxy's motion: the nearest point, where a ray
// meets. They look at the very trees and solids that the proxy touches.
#pragma once

#include "core/geometry/touch_shape.hpp"
#include "core/math/pose.hpp"
#include "core/tree/work.hpp"

namespace tactus {

struct SurfaceHit {
    bool hit = false;
    bool complete = true;        // false: the budget ended the search, a nearer place may exist
    Vec3 point{0.0};             // on the surface, in the world (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};  // unit, from the surface to where was asked from, in the world
    double distance = 0.0;  // from there, negative inside a solid; what was asked for at most where nothing
                            // is hit (unit: meters)
};

// The point of the body's surface nearest to `point` (in the world), where one is nearer than `max_distance`
// (unit: meters). A mesh has no inside: its distance is never negative.
SurfaceHit nearest_surface(const TouchShape& shape, const Pose& body, const Vec3& point, double max_distance,
                           WorkBudget& work);
SurfaceHit nearest_surface(const TouchShape& shape, const Pose& body, const Vec3& point, double max_distance);

// Whether the way from `start` (in the world) along `direction` (unit), `length` meters long, comes near the
// body at all: what does not need not be asked more.
bool may_meet_ray(const TouchShape& shape, const Pose& body, const Vec3& start, const Vec3& direction,
                  double length);

}  // namespace tactus
