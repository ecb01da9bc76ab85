// Jolt's own unit of length, and the way between its values and ours.
//
// Jolt has tolerances in its source that no setting reaches (a GJK distance of 1e-4, a capsule's edge of
// 0.02, a hull's plane of 1e-3) and calls 0.1 to 10 of its units the range it is made for. With 100 of its
// units to a metre, a 5 mm cube is half a unit, 10 m are a thousand, and GJK's tolerance is a micrometre.
// Kilograms and seconds stay, so a force or a velocity scales like a length, a torque or an inertia like its
// square.
#pragma once

#include "core/math/pose.hpp"
#include "physics/jolt.hpp"

namespace tactus::units {

constexpr double jolt_per_meter = 100.0;

constexpr float length(double meters) {
    return static_cast<float>(meters * jolt_per_meter);
}
constexpr float area(double square_meters) {
    return static_cast<float>(square_meters * jolt_per_meter * jolt_per_meter);
}
constexpr double meters(double jolt_length) {
    return jolt_length * (1.0 / jolt_per_meter);
}

// Lengths, velocities, accelerations, forces.
inline JPH::Vec3 vector(const Vec3& v) {
    return {length(v.x), length(v.y), length(v.z)};
}
inline Vec3 vector(JPH::Vec3Arg v) {
    return {meters(v.GetX()), meters(v.GetY()), meters(v.GetZ())};
}

// Torques.
inline JPH::Vec3 torque(const Vec3& v) {
    return {area(v.x), area(v.y), area(v.z)};
}

inline Vec3 untorque(JPH::Vec3Arg v) {
    constexpr double scale = 1.0 / (jolt_per_meter * jolt_per_meter);
    return {v.GetX() * scale, v.GetY() * scale, v.GetZ() * scale};
}

// Directions, angular velocities: no length in them.
inline JPH::Vec3 plain(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline Vec3 plain(JPH::Vec3Arg v) {
    return {v.GetX(), v.GetY(), v.GetZ()};
}

inline JPH::RVec3 position(const Vec3& p) {
    return {static_cast<JPH::Real>(p.x * jolt_per_meter), static_cast<JPH::Real>(p.y * jolt_per_meter),
            static_cast<JPH::Real>(p.z * jolt_per_meter)};
}
inline Vec3 position(JPH::RVec3Arg p) {
    return {meters(p.GetX()), meters(p.GetY()), meters(p.GetZ())};
}

// Jolt wants its float quaternions normalised more tightly than a narrowed double one is.
inline JPH::Quat rotation(const Quat& q) {
    return JPH::Quat(static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
                     static_cast<float>(q.w))
        .Normalized();
}
inline Quat rotation(JPH::QuatArg q) {
    return glm::normalize(Quat(q.GetW(), q.GetX(), q.GetY(), q.GetZ()));
}

}  // namespace tactus::units
