#pragma once

#include <godot_cpp/variant/vector3.hpp>

namespace godot {

// The points p with normal · p = d; "over" is the side the normal points to.
struct Plane {
    Vector3 normal;
    real_t d = 0;

    constexpr Plane() = default;
    constexpr Plane(real_t a, real_t b, real_t c, real_t p_d) : normal(a, b, c), d(p_d) {}
    constexpr Plane(const Vector3& p_normal, real_t p_d = 0) : normal(p_normal), d(p_d) {}
    constexpr Plane(const Vector3& p_normal, const Vector3& point)
        : normal(p_normal), d(p_normal.dot(point)) {}
    operator String() const;

    constexpr Vector3 get_center() const { return normal * d; }
    constexpr real_t distance_to(const Vector3& point) const { return normal.dot(point) - d; }
    constexpr bool is_point_over(const Vector3& point) const { return normal.dot(point) > d; }
    constexpr Vector3 project(const Vector3& point) const { return point - normal * distance_to(point); }
    Plane normalized() const {
        const real_t norm = normal.length();
        return norm == 0 ? Plane() : Plane(normal / norm, d / norm);
    }
    constexpr Plane operator-() const { return Plane(-normal, -d); }
    constexpr bool operator==(const Plane& p) const { return normal == p.normal && d == p.d; }
    constexpr bool operator!=(const Plane& p) const { return !(*this == p); }
};

}  // namespace godot
