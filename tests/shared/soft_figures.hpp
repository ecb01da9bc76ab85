// Bodies that give under a hand, judged by code that shares nothing with the product.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus::shared {

// By the solid angle of every triangle of a closed mesh.
bool winds_around(const TriangleMesh& mesh, const Vec3& point);
double distance_to_surface(const TriangleMesh& mesh, const Vec3& point);
// Of the nearest point of an open mesh, along the normal of its triangle: below 0 behind it.
double height_above(const TriangleMesh& mesh, const Vec3& point);

struct SoftFigures {
    std::size_t nodes = 0, elements = 0, triangles = 0, factor_entries = 0;
    int presses = 0;
    int ticks = 0;
    int contact_ticks = 0;
    int passes = 0;              // ticks with the proxy's centre behind the surface
    int unfinished = 0;          // ticks
    double deepest = 0.0;        // of the surface, pressed in (unit: meters)
    double largest_force = 0.0;  // (unit: newtons)
    // What a hand gets out of one press more than it has put in, at most (unit: joules): with the force
    // between two ticks, and with the one that a device holds until the next.
    double energy_created = 0.0;
    double energy_created_held = 0.0;
    // The latter over k / 2 times the sum of the squares of the hand's ways, which a spring k that is held
    // for a tick may give back, and a device has to damp (core/safety/stiffness_limit.hpp); at most.
    double held_share = 0.0;
    double shape_error = 0.0;                // of the vertices, long after the last press (unit: meters)
    std::vector<double> microseconds;        // of each tick in contact
    std::vector<double> still_microseconds;  // of ticks asleep
};

// A block of 80 mm and 512 cells on its foot, pressed in 10 mm by a point of 10 mm radius and let go,
// at places on its top and its sides. `judged`: one in so many ticks is looked at for passes.
SoftFigures press_block(int presses, double stiffness, int judged);
// A cloth of 1,024 vertices on a frame, pressed in 10 mm, from above.
SoftFigures press_cloth(int presses, double stiffness, int judged);

struct SoftAccuracy {
    double force_error_percent = 0.0;   // while it is pressed in, root mean square, of the largest force
    double static_error_percent = 0.0;  // once it is held still
    double step_microseconds = 0.0;     // median
};
// The force of a press at 0.1 m/s with so many iterations each, beside that of 32.
std::vector<SoftAccuracy> soft_accuracy(double stiffness, std::span<const int> iterations);

}  // namespace tactus::shared
