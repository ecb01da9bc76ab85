#pragma once

#include <godot_cpp/core/math.hpp>
#include <godot_cpp/variant/vector3i.hpp>

namespace godot {

class String;

struct Vector3 {
    enum Axis {
        AXIS_X,
        AXIS_Y,
        AXIS_Z,
    };

    real_t x = 0;
    real_t y = 0;
    real_t z = 0;

    constexpr Vector3() = default;
    constexpr Vector3(real_t p_x, real_t p_y, real_t p_z) : x(p_x), y(p_y), z(p_z) {}
    constexpr Vector3(const Vector3i& v)
        : x(static_cast<real_t>(v.x)), y(static_cast<real_t>(v.y)), z(static_cast<real_t>(v.z)) {}
    operator Vector3i() const {
        return Vector3i(static_cast<int32_t>(x), static_cast<int32_t>(y), static_cast<int32_t>(z));
    }
    operator String() const;

    real_t& operator[](int axis) { return (&x)[axis]; }
    const real_t& operator[](int axis) const { return (&x)[axis]; }

    constexpr Vector3 operator+(const Vector3& v) const { return {x + v.x, y + v.y, z + v.z}; }
    constexpr Vector3 operator-(const Vector3& v) const { return {x - v.x, y - v.y, z - v.z}; }
    constexpr Vector3 operator*(const Vector3& v) const { return {x * v.x, y * v.y, z * v.z}; }
    constexpr Vector3 operator/(const Vector3& v) const { return {x / v.x, y / v.y, z / v.z}; }
    constexpr Vector3 operator*(real_t s) const { return {x * s, y * s, z * s}; }
    constexpr Vector3 operator/(real_t s) const { return {x / s, y / s, z / s}; }
    constexpr Vector3 operator-() const { return {-x, -y, -z}; }
    constexpr Vector3& operator+=(const Vector3& v) { return *this = *this + v; }
    constexpr Vector3& operator-=(const Vector3& v) { return *this = *this - v; }
    constexpr Vector3& operator*=(const Vector3& v) { return *this = *this * v; }
    constexpr Vector3& operator/=(const Vector3& v) { return *this = *this / v; }
    constexpr Vector3& operator*=(real_t s) { return *this = *this * s; }
    constexpr Vector3& operator/=(real_t s) { return *this = *this / s; }
    constexpr bool operator==(const Vector3& v) const { return x == v.x && y == v.y && z == v.z; }
    constexpr bool operator!=(const Vector3& v) const { return !(*this == v); }
    constexpr bool operator<(const Vector3& v) const {
        return x != v.x ? x < v.x : (y != v.y ? y < v.y : z < v.z);
    }

    Vector3 abs() const { return {ABS(x), ABS(y), ABS(z)}; }
    Vector3 sign() const { return {SIGN(x), SIGN(y), SIGN(z)}; }
    constexpr Vector3 min(const Vector3& v) const { return {MIN(x, v.x), MIN(y, v.y), MIN(z, v.z)}; }
    constexpr Vector3 max(const Vector3& v) const { return {MAX(x, v.x), MAX(y, v.y), MAX(z, v.z)}; }
    constexpr Vector3 clamp(const Vector3& low, const Vector3& high) const { return max(low).min(high); }
    constexpr real_t dot(const Vector3& v) const { return x * v.x + y * v.y + z * v.z; }
    constexpr Vector3 cross(const Vector3& v) const {
        return {y * v.z - z * v.y, z * v.x - x * v.z, x * v.y - y * v.x};
    }
    constexpr real_t length_squared() const { return dot(*this); }
    real_t length() const { return std::sqrt(length_squared()); }
    Vector3 normalized() const {
        const real_t norm = length();
        return norm == 0 ? Vector3() : *this / norm;
    }
    void normalize() { *this = normalized(); }
    bool is_normalized() const { return std::abs(length_squared() - real_t(1)) < real_t(UNIT_EPSILON); }
    real_t distance_to(const Vector3& v) const { return (v - *this).length(); }
    constexpr real_t distance_squared_to(const Vector3& v) const { return (v - *this).length_squared(); }
    Vector3 direction_to(const Vector3& v) const { return (v - *this).normalized(); }
    constexpr Vector3 slide(const Vector3& normal) const { return *this - normal * dot(normal); }
    constexpr Vector3 reflect(const Vector3& normal) const { return normal * (2 * dot(normal)) - *this; }
    constexpr Vector3 bounce(const Vector3& normal) const { return -reflect(normal); }
    constexpr Vector3 project(const Vector3& to) const { return to * (dot(to) / to.length_squared()); }
    Vector3 limit_length(real_t limit = 1) const {
        const real_t norm = length();
        return norm > 0 && limit < norm ? *this * (limit / norm) : *this;
    }
    Vector3 move_toward(const Vector3& to, real_t delta) const {
        const real_t distance = distance_to(to);
        return distance <= delta || distance < real_t(CMP_EPSILON)
                   ? to
                   : *this + (to - *this) * (delta / distance);
    }
    constexpr Vector3 lerp(const Vector3& to, real_t weight) const { return *this + (to - *this) * weight; }
    constexpr Vector3 inverse() const { return {1 / x, 1 / y, 1 / z}; }
    Vector3 floor() const { return {std::floor(x), std::floor(y), std::floor(z)}; }
    Vector3 ceil() const { return {std::ceil(x), std::ceil(y), std::ceil(z)}; }
    Vector3 round() const { return {std::round(x), std::round(y), std::round(z)}; }
    bool is_equal_approx(const Vector3& v) const {
        return Math::is_equal_approx(x, v.x) && Math::is_equal_approx(y, v.y) &&
               Math::is_equal_approx(z, v.z);
    }
    bool is_zero_approx() const {
        return Math::is_zero_approx(x) && Math::is_zero_approx(y) && Math::is_zero_approx(z);
    }
    bool is_finite() const { return std::isfinite(x) && std::isfinite(y) && std::isfinite(z); }
    real_t angle_to(const Vector3& to) const { return std::atan2(cross(to).length(), dot(to)); }
    real_t signed_angle_to(const Vector3& to, const Vector3& axis) const {
        const Vector3 normal = cross(to);
        const real_t angle = std::atan2(normal.length(), dot(to));
        return normal.dot(axis) < 0 ? -angle : angle;
    }
    // Rodrigues: v cos a + (k × v) sin a + k (k · v)(1 − cos a), k of unit length.
    Vector3 rotated(const Vector3& axis, real_t angle) const {
        const real_t c = std::cos(angle);
        return *this * c + axis.cross(*this) * std::sin(angle) + axis * (axis.dot(*this) * (1 - c));
    }
};

constexpr Vector3 operator*(real_t s, const Vector3& v) {
    return v * s;
}

}  // namespace godot
