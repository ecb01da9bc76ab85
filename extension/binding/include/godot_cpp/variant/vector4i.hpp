#pragma once

#include <godot_cpp/core/math.hpp>

namespace godot {

class String;

struct Vector4i {
    enum Axis {
        AXIS_X,
        AXIS_Y,
        AXIS_Z,
        AXIS_W,
    };

    int32_t x = 0;
    int32_t y = 0;
    int32_t z = 0;
    int32_t w = 0;

    constexpr Vector4i() = default;
    constexpr Vector4i(int32_t p_x, int32_t p_y, int32_t p_z, int32_t p_w) : x(p_x), y(p_y), z(p_z), w(p_w) {}
    operator String() const;

    int32_t& operator[](int axis) { return (&x)[axis]; }
    const int32_t& operator[](int axis) const { return (&x)[axis]; }

    constexpr Vector4i operator+(const Vector4i& v) const { return {x + v.x, y + v.y, z + v.z, w + v.w}; }
    constexpr Vector4i operator-(const Vector4i& v) const { return {x - v.x, y - v.y, z - v.z, w - v.w}; }
    constexpr Vector4i operator*(const Vector4i& v) const { return {x * v.x, y * v.y, z * v.z, w * v.w}; }
    constexpr Vector4i operator/(const Vector4i& v) const { return {x / v.x, y / v.y, z / v.z, w / v.w}; }
    constexpr Vector4i operator%(const Vector4i& v) const { return {x % v.x, y % v.y, z % v.z, w % v.w}; }
    constexpr Vector4i operator*(int32_t s) const { return {x * s, y * s, z * s, w * s}; }
    constexpr Vector4i operator/(int32_t s) const { return {x / s, y / s, z / s, w / s}; }
    constexpr Vector4i operator%(int32_t s) const { return {x % s, y % s, z % s, w % s}; }
    constexpr Vector4i operator-() const { return {-x, -y, -z, -w}; }
    constexpr Vector4i& operator+=(const Vector4i& v) { return *this = *this + v; }
    constexpr Vector4i& operator-=(const Vector4i& v) { return *this = *this - v; }
    constexpr Vector4i& operator*=(const Vector4i& v) { return *this = *this * v; }
    constexpr Vector4i& operator/=(const Vector4i& v) { return *this = *this / v; }
    constexpr Vector4i& operator*=(int32_t s) { return *this = *this * s; }
    constexpr Vector4i& operator/=(int32_t s) { return *this = *this / s; }
    constexpr bool operator==(const Vector4i& v) const {
        return x == v.x && y == v.y && z == v.z && w == v.w;
    }
    constexpr bool operator!=(const Vector4i& v) const { return !(*this == v); }
    constexpr bool operator<(const Vector4i& v) const {
        return x != v.x ? x < v.x : (y != v.y ? y < v.y : (z != v.z ? z < v.z : w < v.w));
    }

    Vector4i abs() const { return {ABS(x), ABS(y), ABS(z), ABS(w)}; }
    Vector4i sign() const { return {SIGN(x), SIGN(y), SIGN(z), SIGN(w)}; }
    constexpr Vector4i min(const Vector4i& v) const {
        return {MIN(x, v.x), MIN(y, v.y), MIN(z, v.z), MIN(w, v.w)};
    }
    constexpr Vector4i max(const Vector4i& v) const {
        return {MAX(x, v.x), MAX(y, v.y), MAX(z, v.z), MAX(w, v.w)};
    }
    constexpr Vector4i clamp(const Vector4i& low, const Vector4i& high) const { return max(low).min(high); }
    int64_t length_squared() const {
        return static_cast<int64_t>(x) * x + static_cast<int64_t>(y) * y + static_cast<int64_t>(z) * z +
               static_cast<int64_t>(w) * w;
    }
    double length() const { return std::sqrt(static_cast<double>(length_squared())); }
};

constexpr Vector4i operator*(int32_t s, const Vector4i& v) {
    return v * s;
}

}  // namespace godot
