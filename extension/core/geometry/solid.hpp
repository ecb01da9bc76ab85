// The shapes that need no triangles: spheres, boxes, capsules, cylinders and half-spaces have their distance
// in closed form, and a sphere moving against them is a point moving against their inflated surface
// (thesis 3.2.3, 4.3).
#pragma once

#include <array>
#include <variant>

#include "core/geometry/shape.hpp"
#include "core/geometry/surface_end.hpp"
#include "core/tree/hit.hpp"
#include "core/tree/work.hpp"

namespace tactus {

using Solid = std::variant<SphereShape, BoxShape, CapsuleShape, CylinderShape, PlaneShape>;

// Distance of a point from a solid's surface, and how the distance bends there. Outside, distance is a convex
// function of the point with gradient `normal` and second derivatives bend_u along u, bend_v along
// cross(normal, u).
struct SolidDistance {
    double distance = 0.0;             // negative inside (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};        // unit, away from the solid, in the solid's frame
    Vec3 u{1.0, 0.0, 0.0};             // unit, perpendicular to normal
    double bend_u = 0.0;               // (unit: 1/meter)
    double bend_v = 0.0;               // (unit: 1/meter)
    std::array<SurfaceEnd, 3> ends{};  // where an edge or corner ends and the bends with it
    int end_count = 0;

    bool is_flat() const { return bend_u == 0.0 && bend_v == 0.0; }
};

SolidDistance distance_to_solid(const Solid& solid, const Vec3& point);

// Where the solid stops the sphere at t <= limit. Same rules as sweep_to_triangles.
Hit sweep_to_solid(const Solid& solid, const SphereWay& way, double limit, WorkBudget& work);

// Radius of the ball around the solid's own origin that holds it; infinite for a half-space.
double bounding_radius(const Solid& solid);

}  // namespace tactus
