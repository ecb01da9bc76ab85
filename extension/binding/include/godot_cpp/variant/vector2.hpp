#pragma once

#include <godot_cpp/core/math.hpp>
#include <godot_cpp/variant/vector2i.hpp>

namespace godot {

class String;

struct Vector2 {
    enum Axis {
        AXIS_X,
        AXIS_Y,
    };

    real_t x = 0;
    real_t y = 0;

    constexpr Vector2() = default;
    constexpr Vector2(real_t p_x, real_t p_y) : x(p_x), y(p_y) {}
    constexpr Vector2(const Vector2i& v) : x(static_cast<real_t>(v.x)), y(static_cast<real_t>(v.y)) {}
    operator Vector2i() const { return Vector2i(static_cast<int32_t>(x), static_cast<int32_t>(y)); }
    operator String() const;

    real_t& operator[](int axis) { return (&x)[axis]; }
    const real_t& operator[](int axis) const { return (&x)[axis]; }

    constexpr Vector2 operator+(const Vector2& v) const { return {x + v.x, y + v.y}; }
    constexpr Vector2 operator-(const Vector2& v) const { return {x - v.x, y - v.y}; }
    constexpr Vector2 operator*(const Vector2& v) const { return {x * v.x, y * v.y}; }
    constexpr Vector2 operator/(const Vector2& v) const { return {x / v.x, y / v.y}; }
    constexpr Vector2 operator*(real_t s) const { return {x * s, y * s}; }
    constexpr Vector2 operator/(real_t s) const { return {x / s, y / s}; }
    constexpr Vector2 operator-() const { return {-x, -y}; }
    constexpr Vector2& operator+=(const Vector2& v) { return *this = *this + v; }
    constexpr Vector2& operator-=(const Vector2& v) { return *this = *this - v; }
    constexpr Vector2& operator*=(const Vector2& v) { return *this = *this * v; }
    constexpr Vector2& operator/=(const Vector2& v) { return *this = *this / v; }
    constexpr Vector2& operator*=(real_t s) { return *this = *this * s; }
    constexpr Vector2& operator/=(real_t s) { return *this = *this / s; }
    constexpr bool operator==(const Vector2& v) const { return x == v.x && y == v.y; }
    constexpr bool operator!=(const Vector2& v) const { return !(*this == v); }
    constexpr bool operator<(const Vector2& v) const { return x != v.x ? x < v.x : y < v.y; }

    Vector2 abs() const { return {ABS(x), ABS(y)}; }
    Vector2 sign() const { return {SIGN(x), SIGN(y)}; }
    constexpr Vector2 min(const Vector2& v) const { return {MIN(x, v.x), MIN(y, v.y)}; }
    constexpr Vector2 max(const Vector2& v) const { return {MAX(x, v.x), MAX(y, v.y)}; }
    constexpr Vector2 clamp(const Vector2& low, const Vector2& high) const { return max(low).min(high); }
    constexpr real_t dot(const Vector2& v) const { return x * v.x + y * v.y; }
    constexpr real_t cross(const Vector2& v) const { return x * v.y - y * v.x; }
    constexpr real_t length_squared() const { return dot(*this); }
    real_t length() const { return std::sqrt(length_squared()); }
    Vector2 normalized() const {
        const real_t norm = length();
        return norm == 0 ? Vector2() : *this / norm;
    }
    void normalize() { *this = normalized(); }
    bool is_normalized() const { return std::abs(length_squared() - real_t(1)) < real_t(UNIT_EPSILON); }
    real_t distance_to(const Vector2& v) const { return (v - *this).length(); }
    constexpr real_t distance_squared_to(const Vector2& v) const { return (v - *this).length_squared(); }
    Vector2 direction_to(const Vector2& v) const { return (v - *this).normalized(); }
    constexpr Vector2 slide(const Vector2& normal) const { return *this - normal * dot(normal); }
    constexpr Vector2 reflect(const Vector2& normal) const { return normal * (2 * dot(normal)) - *this; }
    constexpr Vector2 bounce(const Vector2& normal) const { return -reflect(normal); }
    constexpr Vector2 project(const Vector2& to) const { return to * (dot(to) / to.length_squared()); }
    Vector2 limit_length(real_t limit = 1) const {
        const real_t norm = length();
        return norm > 0 && limit < norm ? *this * (limit / norm) : *this;
    }
    Vector2 move_toward(const Vector2& to, real_t delta) const {
        const real_t distance = distance_to(to);
        return distance <= delta || distance < real_t(CMP_EPSILON)
                   ? to
                   : *this + (to - *this) * (delta / distance);
    }
    constexpr Vector2 lerp(const Vector2& to, real_t weight) const { return *this + (to - *this) * weight; }
    constexpr Vector2 inverse() const { return {1 / x, 1 / y}; }
    Vector2 floor() const { return {std::floor(x), std::floor(y)}; }
    Vector2 ceil() const { return {std::ceil(x), std::ceil(y)}; }
    Vector2 round() const { return {std::round(x), std::round(y)}; }
    bool is_equal_approx(const Vector2& v) const {
        return Math::is_equal_approx(x, v.x) && Math::is_equal_approx(y, v.y);
    }
    bool is_zero_approx() const { return Math::is_zero_approx(x) && Math::is_zero_approx(y); }
    bool is_finite() const { return std::isfinite(x) && std::isfinite(y); }
    real_t angle() const { return std::atan2(y, x); }
    real_t angle_to(const Vector2& to) const { return std::atan2(cross(to), dot(to)); }
    real_t aspect() const { return x / y; }
    constexpr Vector2 orthogonal() const { return {y, -x}; }
    Vector2 rotated(real_t angle) const {
        const real_t s = std::sin(angle);
        const real_t c = std::cos(angle);
        return {x * c - y * s, x * s + y * c};
    }
};

constexpr Vector2 operator*(real_t s, const Vector2& v) {
    return v * s;
}

using Size2 = Vector2;
using Point2 = Vector2;

}  // namespace godot
