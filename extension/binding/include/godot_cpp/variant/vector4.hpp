#pragma once

#include <godot_cpp/core/math.hpp>
#include <godot_cpp/variant/vector4i.hpp>

namespace godot {

class String;

struct Vector4 {
    enum Axis {
        AXIS_X,
        AXIS_Y,
        AXIS_Z,
        AXIS_W,
    };

    real_t x = 0;
    real_t y = 0;
    real_t z = 0;
    real_t w = 0;

    constexpr Vector4() = default;
    constexpr Vector4(real_t p_x, real_t p_y, real_t p_z, real_t p_w) : x(p_x), y(p_y), z(p_z), w(p_w) {}
    constexpr Vector4(const Vector4i& v)
        : x(static_cast<real_t>(v.x)),
          y(static_cast<real_t>(v.y)),
          z(static_cast<real_t>(v.z)),
          w(static_cast<real_t>(v.w)) {}
    operator Vector4i() const {
        return Vector4i(static_cast<int32_t>(x), static_cast<int32_t>(y), static_cast<int32_t>(z),
                        static_cast<int32_t>(w));
    }
    operator String() const;

    real_t& operator[](int axis) { return (&x)[axis]; }
    const real_t& operator[](int axis) const { return (&x)[axis]; }

    constexpr Vector4 operator+(const Vector4& v) const { return {x + v.x, y + v.y, z + v.z, w + v.w}; }
    constexpr Vector4 operator-(const Vector4& v) const { return {x - v.x, y - v.y, z - v.z, w - v.w}; }
    constexpr Vector4 operator*(const Vector4& v) const { return {x * v.x, y * v.y, z * v.z, w * v.w}; }
    constexpr Vector4 operator/(const Vector4& v) const { return {x / v.x, y / v.y, z / v.z, w / v.w}; }
    constexpr Vector4 operator*(real_t s) const { return {x * s, y * s, z * s, w * s}; }
    constexpr Vector4 operator/(real_t s) const { return {x / s, y / s, z / s, w / s}; }
    constexpr Vector4 operator-() const { return {-x, -y, -z, -w}; }
    constexpr Vector4& operator+=(const Vector4& v) { return *this = *this + v; }
    constexpr Vector4& operator-=(const Vector4& v) { return *this = *this - v; }
    constexpr Vector4& operator*=(const Vector4& v) { return *this = *this * v; }
    constexpr Vector4& operator/=(const Vector4& v) { return *this = *this / v; }
    constexpr Vector4& operator*=(real_t s) { return *this = *this * s; }
    constexpr Vector4& operator/=(real_t s) { return *this = *this / s; }
    constexpr bool operator==(const Vector4& v) const { return x == v.x && y == v.y && z == v.z && w == v.w; }
    constexpr bool operator!=(const Vector4& v) const { return !(*this == v); }
    constexpr bool operator<(const Vector4& v) const {
        return x != v.x ? x < v.x : (y != v.y ? y < v.y : (z != v.z ? z < v.z : w < v.w));
    }

    Vector4 abs() const { return {ABS(x), ABS(y), ABS(z), ABS(w)}; }
    Vector4 sign() const { return {SIGN(x), SIGN(y), SIGN(z), SIGN(w)}; }
    constexpr Vector4 min(const Vector4& v) const {
        return {MIN(x, v.x), MIN(y, v.y), MIN(z, v.z), MIN(w, v.w)};
    }
    constexpr Vector4 max(const Vector4& v) const {
        return {MAX(x, v.x), MAX(y, v.y), MAX(z, v.z), MAX(w, v.w)};
    }
    constexpr Vector4 clamp(const Vector4& low, const Vector4& high) const { return max(low).min(high); }
    constexpr real_t dot(const Vector4& v) const { return x * v.x + y * v.y + z * v.z + w * v.w; }
    constexpr real_t length_squared() const { return dot(*this); }
    real_t length() const { return std::sqrt(length_squared()); }
    Vector4 normalized() const {
        const real_t norm = length();
        return norm == 0 ? Vector4() : *this / norm;
    }
    void normalize() { *this = normalized(); }
    bool is_normalized() const { return std::abs(length_squared() - real_t(1)) < real_t(UNIT_EPSILON); }
    real_t distance_to(const Vector4& v) const { return (v - *this).length(); }
    constexpr real_t distance_squared_to(const Vector4& v) const { return (v - *this).length_squared(); }
    constexpr Vector4 lerp(const Vector4& to, real_t weight) const { return *this + (to - *this) * weight; }
    constexpr Vector4 inverse() const { return {1 / x, 1 / y, 1 / z, 1 / w}; }
    Vector4 floor() const { return {std::floor(x), std::floor(y), std::floor(z), std::floor(w)}; }
    Vector4 ceil() const { return {std::ceil(x), std::ceil(y), std::ceil(z), std::ceil(w)}; }
    Vector4 round() const { return {std::round(x), std::round(y), std::round(z), std::round(w)}; }
    bool is_equal_approx(const Vector4& v) const {
        return Math::is_equal_approx(x, v.x) && Math::is_equal_approx(y, v.y) &&
               Math::is_equal_approx(z, v.z) && Math::is_equal_approx(w, v.w);
    }
    bool is_zero_approx() const {
        return Math::is_zero_approx(x) && Math::is_zero_approx(y) && Math::is_zero_approx(z) &&
               Math::is_zero_approx(w);
    }
    bool is_finite() const {
        return std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(w);
    }
};

constexpr Vector4 operator*(real_t s, const Vector4& v) {
    return v * s;
}

}  // namespace godot
