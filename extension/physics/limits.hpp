// What a world takes. Jolt computes in single precision: what is not a number, or so large that products of a
// few such values leave its range, would spread to everything that the body touches. All of it is far beyond
// any thing that a hand could feel.
//
// Not a number, or no place: the call does nothing. Too large: it is cut off here.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/pose.hpp"

namespace tactus::limits {

constexpr double farthest = 1e7;                    // of a body from the origin (unit: meters)
constexpr double longest_arm = 1e5;                 // of a force from the centre of mass (unit: meters)
constexpr double fastest = 1e4;                     // (unit: meters per second)
constexpr double fastest_spin = 2000.0;             // (unit: radians per second)
constexpr double strongest = 1e7;                   // (unit: newtons, newton meters)
constexpr double weakest = 1e-12;                   // of a hand's spring (unit: newtons)
constexpr double stiffest = 1e9;                    // (unit: newtons per meter; newton seconds per meter)
constexpr double lightest = 1e-6, heaviest = 1e12;  // (unit: kilograms)
constexpr double least_inertia = 1e-18, max_inertia = 1e18;  // (unit: kilogram square meters)
// Of what the shapes filled evenly have: below, the solver's iterations do not bear a body at its corners,
// and it sinks into what it rests on (dimensionless).
constexpr double least_inertia_share = 0.01;
constexpr double max_gravity = 1e5;        // (unit: meters per square second)
constexpr double max_gravity_scale = 1e4;  // (dimensionless)
constexpr double max_friction = 1e3;       // (dimensionless)
constexpr double shortest_way = 1e-6;      // in time, that a body can be told (unit: seconds)

inline bool is_number(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline bool is_place(const Vec3& p) {
    return std::abs(p.x) <= farthest && std::abs(p.y) <= farthest && std::abs(p.z) <= farthest;
}

inline bool is_rotation(const Quat& q) {
    return std::abs(glm::length(q) - 1.0) < 1e-3;
}

inline bool is_pose(const Pose& pose) {
    return is_place(pose.position) && is_rotation(pose.rotation);
}

inline double cut(double value, double most) {
    return std::clamp(value, -most, most);
}

inline Vec3 cut(const Vec3& v, double most) {
    return {cut(v.x, most), cut(v.y, most), cut(v.z, most)};
}

}  // namespace tactus::limits
