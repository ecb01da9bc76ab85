#pragma once

#include <godot_cpp/variant/aabb.hpp>
#include <godot_cpp/variant/basis.hpp>
#include <godot_cpp/variant/plane.hpp>

namespace godot {

// p ↦ basis · p + origin
struct Transform3D {
    Basis basis;
    Vector3 origin;

    constexpr Transform3D() = default;
    constexpr Transform3D(const Basis& p_basis, const Vector3& p_origin = Vector3())
        : basis(p_basis), origin(p_origin) {}
    constexpr Transform3D(const Vector3& x, const Vector3& y, const Vector3& z, const Vector3& p_origin)
        : basis(x, y, z), origin(p_origin) {}
    constexpr Transform3D(real_t xx, real_t xy, real_t xz, real_t yx, real_t yy, real_t yz, real_t zx,
                          real_t zy, real_t zz, real_t ox, real_t oy, real_t oz)
        : basis(xx, xy, xz, yx, yy, yz, zx, zy, zz), origin(ox, oy, oz) {}
    operator String() const;

    constexpr Vector3 xform(const Vector3& p) const { return basis.xform(p) + origin; }
    // Of a rigid transform (no scale): Rᵀ (p − t).
    constexpr Vector3 xform_inv(const Vector3& p) const { return basis.xform_inv(p - origin); }
    constexpr Transform3D inverse() const {
        const Basis transposed = basis.transposed();
        return Transform3D(transposed, transposed.xform(-origin));
    }
    constexpr Transform3D affine_inverse() const {
        const Basis inverted = basis.inverse();
        return Transform3D(inverted, inverted.xform(-origin));
    }
    Transform3D orthonormalized() const { return Transform3D(basis.orthonormalized(), origin); }
    Transform3D rotated(const Vector3& axis, real_t angle) const {
        return Transform3D(Basis(axis, angle)) * *this;
    }
    Transform3D rotated_local(const Vector3& axis, real_t angle) const {
        return Transform3D(basis * Basis(axis, angle), origin);
    }
    constexpr Transform3D scaled(const Vector3& s) const { return Transform3D(basis.scaled(s), origin * s); }
    constexpr Transform3D scaled_local(const Vector3& s) const {
        return Transform3D(basis.scaled_local(s), origin);
    }
    constexpr Transform3D translated(const Vector3& by) const { return Transform3D(basis, origin + by); }
    constexpr Transform3D translated_local(const Vector3& by) const {
        return Transform3D(basis, origin + basis.xform(by));
    }
    Transform3D looking_at(const Vector3& target, const Vector3& up = Vector3(0, 1, 0),
                           bool use_model_front = false) const {
        return Transform3D(Basis::looking_at(target - origin, up, use_model_front), origin);
    }
    Transform3D interpolate_with(const Transform3D& to, real_t weight) const;
    bool is_equal_approx(const Transform3D& t) const {
        return basis.is_equal_approx(t.basis) && origin.is_equal_approx(t.origin);
    }
    bool is_finite() const { return basis.is_finite() && origin.is_finite(); }

    constexpr Transform3D operator*(const Transform3D& t) const {
        return Transform3D(basis * t.basis, xform(t.origin));
    }
    constexpr Transform3D& operator*=(const Transform3D& t) { return *this = *this * t; }
    constexpr bool operator==(const Transform3D& t) const { return basis == t.basis && origin == t.origin; }
    constexpr bool operator!=(const Transform3D& t) const { return !(*this == t); }
};

}  // namespace godot
