// Volume, centroid and inertia of a solid of density 1: what mass and rotation are made of.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/shape.hpp"
#include "core/math/types.hpp"

namespace tactus {

struct SolidProperties {
    double volume = 0.0;  // (unit: cubic meters), > 0
    Vec3 centroid{0.0};   // (unit: meters)
    Mat3 inertia{0.0};    // about the centroid, for density 1 (unit: meters^5)
};

// Absent for what encloses no volume: a plane, a height field, an open or inside-out mesh.
std::optional<SolidProperties> solid_properties(const Shape& shape);
std::optional<SolidProperties> solid_properties(const TriangleMesh& mesh);

SolidProperties placed(const SolidProperties& solid, const Pose& pose);

// Overlapping parts count twice. `parts` is not empty.
SolidProperties combined(const std::vector<SolidProperties>& parts);

// The inertia of a solid about a point other than its centroid (parallel axes).
Mat3 inertia_about(const SolidProperties& solid, const Vec3& point);

// The moment about an axis is at most the sum of the other two: otherwise some of the mass would be negative,
// and contacts would give energy. Flat bodies have the sum itself, in Godot's single precision.
bool is_possible_inertia(const Vec3& moments);

// Principal moments of inertia as those of a body: the second moments of its mass along the axes,
// (I_y + I_z - I_x) / 2 and so on, are 0 where they would be negative. Where one is, the largest moment stays
// and the other two grow to those of a flat plate. `moments` are > 0.
Vec3 possible_inertia(const Vec3& moments);

}  // namespace tactus
