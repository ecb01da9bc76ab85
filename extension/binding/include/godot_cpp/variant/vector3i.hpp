#pragma once

#include <godot_cpp/core/math.hpp>

namespace godot {

class String;

struct Vector3i {
    enum Axis {
        AXIS_X,
        AXIS_Y,
        AXIS_Z,
    };

    int32_t x = 0;
    int32_t y = 0;
    int32_t z = 0;

    constexpr Vector3i() = default;
    constexpr Vector3i(int32_t p_x, int32_t p_y, int32_t p_z) : x(p_x), y(p_y), z(p_z) {}
    operator String() const;

    int32_t& operator[](int axis) { return (&x)[axis]; }
    const int32_t& operator[](int axis) const { return (&x)[axis]; }

    constexpr Vector3i operator+(const Vector3i& v) const { return {x + v.x, y + v.y, z + v.z}; }
    constexpr Vector3i operator-(const Vector3i& v) const { return {x - v.x, y - v.y, z - v.z}; }
    constexpr Vector3i operator*(const Vector3i& v) const { return {x * v.x, y * v.y, z * v.z}; }
    constexpr Vector3i operator/(const Vector3i& v) const { return {x / v.x, y / v.y, z / v.z}; }
    constexpr Vector3i operator%(const Vector3i& v) const { return {x % v.x, y % v.y, z % v.z}; }
    constexpr Vector3i operator*(int32_t s) const { return {x * s, y * s, z * s}; }
    constexpr Vector3i operator/(int32_t s) const { return {x / s, y / s, z / s}; }
    constexpr Vector3i operator%(int32_t s) const { return {x % s, y % s, z % s}; }
    constexpr Vector3i operator-() const { return {-x, -y, -z}; }
    constexpr Vector3i& operator+=(const Vector3i& v) { return *this = *this + v; }
    constexpr Vector3i& operator-=(const Vector3i& v) { return *this = *this - v; }
    constexpr Vector3i& operator*=(const Vector3i& v) { return *this = *this * v; }
    constexpr Vector3i& operator/=(const Vector3i& v) { return *this = *this / v; }
    constexpr Vector3i& operator*=(int32_t s) { return *this = *this * s; }
    constexpr Vector3i& operator/=(int32_t s) { return *this = *this / s; }
    constexpr bool operator==(const Vector3i& v) const { return x == v.x && y == v.y && z == v.z; }
    constexpr bool operator!=(const Vector3i& v) const { return !(*this == v); }
    constexpr bool operator<(const Vector3i& v) const {
        return x != v.x ? x < v.x : (y != v.y ? y < v.y : z < v.z);
    }

    Vector3i abs() const { return {ABS(x), ABS(y), ABS(z)}; }
    Vector3i sign() const { return {SIGN(x), SIGN(y), SIGN(z)}; }
    constexpr Vector3i min(const Vector3i& v) const { return {MIN(x, v.x), MIN(y, v.y), MIN(z, v.z)}; }
    constexpr Vector3i max(const Vector3i& v) const { return {MAX(x, v.x), MAX(y, v.y), MAX(z, v.z)}; }
    constexpr Vector3i clamp(const Vector3i& low, const Vector3i& high) const { return max(low).min(high); }
    int64_t length_squared() const {
        return static_cast<int64_t>(x) * x + static_cast<int64_t>(y) * y + static_cast<int64_t>(z) * z;
    }
    double length() const { return std::sqrt(static_cast<double>(length_squared())); }
};

constexpr Vector3i operator*(int32_t s, const Vector3i& v) {
    return v * s;
}

}  // namespace godot
