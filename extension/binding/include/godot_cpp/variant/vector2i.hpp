#pragma once

#include <godot_cpp/core/math.hpp>

namespace godot {

class String;

struct Vector2i {
    enum Axis {
        AXIS_X,
        AXIS_Y,
    };

    int32_t x = 0;
    int32_t y = 0;

    constexpr Vector2i() = default;
    constexpr Vector2i(int32_t p_x, int32_t p_y) : x(p_x), y(p_y) {}
    operator String() const;

    int32_t& operator[](int axis) { return (&x)[axis]; }
    const int32_t& operator[](int axis) const { return (&x)[axis]; }

    constexpr Vector2i operator+(const Vector2i& v) const { return {x + v.x, y + v.y}; }
    constexpr Vector2i operator-(const Vector2i& v) const { return {x - v.x, y - v.y}; }
    constexpr Vector2i operator*(const Vector2i& v) const { return {x * v.x, y * v.y}; }
    constexpr Vector2i operator/(const Vector2i& v) const { return {x / v.x, y / v.y}; }
    constexpr Vector2i operator%(const Vector2i& v) const { return {x % v.x, y % v.y}; }
    constexpr Vector2i operator*(int32_t s) const { return {x * s, y * s}; }
    constexpr Vector2i operator/(int32_t s) const { return {x / s, y / s}; }
    constexpr Vector2i operator%(int32_t s) const { return {x % s, y % s}; }
    constexpr Vector2i operator-() const { return {-x, -y}; }
    constexpr Vector2i& operator+=(const Vector2i& v) { return *this = *this + v; }
    constexpr Vector2i& operator-=(const Vector2i& v) { return *this = *this - v; }
    constexpr Vector2i& operator*=(const Vector2i& v) { return *this = *this * v; }
    constexpr Vector2i& operator/=(const Vector2i& v) { return *this = *this / v; }
    constexpr Vector2i& operator*=(int32_t s) { return *this = *this * s; }
    constexpr Vector2i& operator/=(int32_t s) { return *this = *this / s; }
    constexpr bool operator==(const Vector2i& v) const { return x == v.x && y == v.y; }
    constexpr bool operator!=(const Vector2i& v) const { return !(*this == v); }
    constexpr bool operator<(const Vector2i& v) const { return x != v.x ? x < v.x : y < v.y; }

    Vector2i abs() const { return {ABS(x), ABS(y)}; }
    Vector2i sign() const { return {SIGN(x), SIGN(y)}; }
    constexpr Vector2i min(const Vector2i& v) const { return {MIN(x, v.x), MIN(y, v.y)}; }
    constexpr Vector2i max(const Vector2i& v) const { return {MAX(x, v.x), MAX(y, v.y)}; }
    constexpr Vector2i clamp(const Vector2i& low, const Vector2i& high) const { return max(low).min(high); }
    int64_t length_squared() const { return static_cast<int64_t>(x) * x + static_cast<int64_t>(y) * y; }
    double length() const { return std::sqrt(static_cast<double>(length_squared())); }
};

constexpr Vector2i operator*(int32_t s, const Vector2i& v) {
    return v * s;
}

using Size2i = Vector2i;
using Point2i = Vector2i;

}  // namespace godot
