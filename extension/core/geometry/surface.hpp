// The surface of one part, whatever it is made of: what touches a sphere where, and when. In the part's own
// frame. A body of several spheres asks for each in turn, with the same budget.
#pragma once

#include "core/geometry/touch_shape.hpp"
#include "core/tree/closest_point_on_triangle.hpp"
#include "core/tree/hit.hpp"

namespace tactus {

// Where one feature of a surface (a triangle by its slot, or all of a shape in closed form) is nearest to a
// point.
struct SurfacePoint {
    double distance = 0.0;       // negative inside a solid (unit: meters)
    Vec3 point{0.0};             // on the surface (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};  // unit, from the surface to the point asked for
    TriangleFeature kind = TriangleFeature::face;
    std::uint8_t edge = 0;  // of the triangle where kind is edge, see TriangleClosestPoint
};

SurfacePoint surface_point(const TouchPart& part, std::uint32_t triangle, const Vec3& center);

// The first feature that stops the sphere at t <= limit.
Hit sweep_surface(const TouchPart& part, const SphereWay& way, double limit, WorkBudget& work);

}  // namespace tactus
