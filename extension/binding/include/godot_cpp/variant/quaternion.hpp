#pragma once

#include <godot_cpp/variant/vector3.hpp>

namespace godot {

// A rotation when of unit length: (axis · sin a/2, cos a/2).
struct Quaternion {
    real_t x = 0;
    real_t y = 0;
    real_t z = 0;
    real_t w = 1;

    constexpr Quaternion() = default;
    constexpr Quaternion(real_t p_x, real_t p_y, real_t p_z, real_t p_w) : x(p_x), y(p_y), z(p_z), w(p_w) {}
    Quaternion(const Vector3& axis, real_t angle) {
        const real_t length = axis.length();
        const real_t s = length == 0 ? 0 : std::sin(angle * real_t(0.5)) / length;
        *this =
            Quaternion(axis.x * s, axis.y * s, axis.z * s, length == 0 ? 0 : std::cos(angle * real_t(0.5)));
    }
    operator String() const;

    real_t& operator[](int index) { return (&x)[index]; }
    const real_t& operator[](int index) const { return (&x)[index]; }

    constexpr real_t dot(const Quaternion& q) const { return x * q.x + y * q.y + z * q.z + w * q.w; }
    constexpr real_t length_squared() const { return dot(*this); }
    real_t length() const { return std::sqrt(length_squared()); }
    Quaternion normalized() const { return *this / length(); }
    void normalize() { *this = normalized(); }
    bool is_normalized() const { return std::abs(length_squared() - real_t(1)) < real_t(UNIT_EPSILON); }
    constexpr Quaternion inverse() const { return {-x, -y, -z, w}; }
    bool is_equal_approx(const Quaternion& q) const {
        return Math::is_equal_approx(x, q.x) && Math::is_equal_approx(y, q.y) &&
               Math::is_equal_approx(z, q.z) && Math::is_equal_approx(w, q.w);
    }
    bool is_finite() const {
        return std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(w);
    }
    real_t get_angle() const { return 2 * std::acos(CLAMP(w, real_t(-1), real_t(1))); }
    Vector3 get_axis() const {
        const Vector3 v(x, y, z);
        return std::abs(w) > 1 - real_t(CMP_EPSILON) ? v : v / std::sqrt(1 - w * w);
    }
    real_t angle_to(const Quaternion& q) const {
        const real_t d = dot(q);
        return std::acos(CLAMP(2 * d * d - 1, real_t(-1), real_t(1)));
    }

    // v + 2 w (u × v) + 2 u × (u × v), u the vector part.
    constexpr Vector3 xform(const Vector3& v) const {
        const Vector3 u(x, y, z);
        const Vector3 uv = u.cross(v);
        return v + (uv * w + u.cross(uv)) * real_t(2);
    }
    constexpr Vector3 xform_inv(const Vector3& v) const { return inverse().xform(v); }

    Quaternion slerp(const Quaternion& to, real_t weight) const {
        const real_t cosine = dot(to);
        const Quaternion near = cosine < 0 ? -to : to;
        // Below this angle sin(angle) loses its digits and the straight line is as good.
        if (1 - std::abs(cosine) <= real_t(CMP_EPSILON)) {
            return *this * (1 - weight) + near * weight;
        }
        const real_t angle = std::acos(std::abs(cosine));
        const real_t s = std::sin(angle);
        return *this * (std::sin((1 - weight) * angle) / s) + near * (std::sin(weight * angle) / s);
    }

    constexpr Quaternion operator*(const Quaternion& q) const {
        return {w * q.x + x * q.w + y * q.z - z * q.y, w * q.y + y * q.w + z * q.x - x * q.z,
                w * q.z + z * q.w + x * q.y - y * q.x, w * q.w - x * q.x - y * q.y - z * q.z};
    }
    constexpr Quaternion operator+(const Quaternion& q) const { return {x + q.x, y + q.y, z + q.z, w + q.w}; }
    constexpr Quaternion operator-(const Quaternion& q) const { return {x - q.x, y - q.y, z - q.z, w - q.w}; }
    constexpr Quaternion operator-() const { return {-x, -y, -z, -w}; }
    constexpr Quaternion operator*(real_t s) const { return {x * s, y * s, z * s, w * s}; }
    constexpr Quaternion operator/(real_t s) const { return {x / s, y / s, z / s, w / s}; }
    constexpr Quaternion& operator*=(const Quaternion& q) { return *this = *this * q; }
    constexpr bool operator==(const Quaternion& q) const {
        return x == q.x && y == q.y && z == q.z && w == q.w;
    }
    constexpr bool operator!=(const Quaternion& q) const { return !(*this == q); }
};

}  // namespace godot
