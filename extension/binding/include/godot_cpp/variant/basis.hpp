#pragma once

#include <godot_cpp/classes/global_constants.hpp>
#include <godot_cpp/variant/quaternion.hpp>
#include <godot_cpp/variant/vector3.hpp>

namespace godot {

// A 3 × 3 matrix, stored by rows; its columns are the axes of the frame it describes.
struct Basis {
    Vector3 rows[3] = {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)};

    constexpr Basis() = default;
    constexpr Basis(const Vector3& x_axis, const Vector3& y_axis, const Vector3& z_axis)
        : rows{Vector3(x_axis.x, y_axis.x, z_axis.x), Vector3(x_axis.y, y_axis.y, z_axis.y),
               Vector3(x_axis.z, y_axis.z, z_axis.z)} {}
    constexpr Basis(real_t xx, real_t xy, real_t xz, real_t yx, real_t yy, real_t yz, real_t zx, real_t zy,
                    real_t zz)
        : rows{Vector3(xx, xy, xz), Vector3(yx, yy, yz), Vector3(zx, zy, zz)} {}
    Basis(const Quaternion& q);
    Basis(const Vector3& axis, real_t angle) : Basis(Quaternion(axis.normalized(), angle)) {}
    operator String() const;
    operator Quaternion() const { return get_quaternion(); }

    Vector3& operator[](int row) { return rows[row]; }
    const Vector3& operator[](int row) const { return rows[row]; }
    constexpr Vector3 get_column(int i) const { return Vector3(entry(0, i), entry(1, i), entry(2, i)); }
    void set_column(int i, const Vector3& v) {
        rows[0][i] = v.x;
        rows[1][i] = v.y;
        rows[2][i] = v.z;
    }
    void set_columns(const Vector3& x, const Vector3& y, const Vector3& z) { *this = Basis(x, y, z); }

    constexpr Vector3 xform(const Vector3& v) const {
        return {rows[0].dot(v), rows[1].dot(v), rows[2].dot(v)};
    }
    constexpr Vector3 xform_inv(const Vector3& v) const { return transposed().xform(v); }
    constexpr Basis transposed() const { return Basis(rows[0], rows[1], rows[2]); }
    constexpr real_t determinant() const { return get_column(0).cross(get_column(1)).dot(get_column(2)); }
    // The rows of the inverse are the cross products of the columns over the determinant.
    constexpr Basis inverse() const {
        const Vector3 x = get_column(0);
        const Vector3 y = get_column(1);
        const Vector3 z = get_column(2);
        const real_t s = 1 / determinant();
        return Basis(y.cross(z) * s, z.cross(x) * s, x.cross(y) * s).transposed();
    }
    Basis orthonormalized() const {
        const Vector3 x = get_column(0).normalized();
        Vector3 y = get_column(1);
        y = (y - x * x.dot(y)).normalized();
        Vector3 z = get_column(2);
        z = (z - x * x.dot(z) - y * y.dot(z)).normalized();
        return Basis(x, y, z);
    }
    void orthonormalize() { *this = orthonormalized(); }

    Vector3 get_scale_abs() const {
        return Vector3(get_column(0).length(), get_column(1).length(), get_column(2).length());
    }
    // A mirrored frame has all three scales negative.
    Vector3 get_scale() const { return get_scale_abs() * (determinant() < 0 ? real_t(-1) : real_t(1)); }
    constexpr Basis scaled(const Vector3& s) const {
        Basis result = *this;
        result.rows[0] *= s.x;
        result.rows[1] *= s.y;
        result.rows[2] *= s.z;
        return result;
    }
    constexpr Basis scaled_local(const Vector3& s) const {
        return Basis(get_column(0) * s.x, get_column(1) * s.y, get_column(2) * s.z);
    }
    static constexpr Basis from_scale(const Vector3& s) { return Basis(s.x, 0, 0, 0, s.y, 0, 0, 0, s.z); }

    Basis rotated(const Vector3& axis, real_t angle) const { return Basis(axis, angle) * *this; }
    Quaternion get_quaternion() const;
    // Of a frame that may be scaled or mirrored.
    Quaternion get_rotation_quaternion() const;
    Vector3 get_euler(EulerOrder order = EULER_ORDER_YXZ) const;
    static Basis from_euler(const Vector3& euler, EulerOrder order = EULER_ORDER_YXZ);
    static Basis looking_at(const Vector3& target, const Vector3& up = Vector3(0, 1, 0),
                            bool use_model_front = false);
    Basis slerp(const Basis& to, real_t weight) const {
        return Basis(get_rotation_quaternion().slerp(to.get_rotation_quaternion(), weight));
    }

    bool is_equal_approx(const Basis& b) const {
        return rows[0].is_equal_approx(b.rows[0]) && rows[1].is_equal_approx(b.rows[1]) &&
               rows[2].is_equal_approx(b.rows[2]);
    }
    bool is_finite() const { return rows[0].is_finite() && rows[1].is_finite() && rows[2].is_finite(); }

    constexpr Basis operator*(const Basis& b) const {
        return Basis(xform(b.get_column(0)), xform(b.get_column(1)), xform(b.get_column(2)));
    }
    constexpr Basis operator*(real_t s) const {
        return Basis(get_column(0) * s, get_column(1) * s, get_column(2) * s);
    }
    constexpr Basis& operator*=(const Basis& b) { return *this = *this * b; }
    constexpr bool operator==(const Basis& b) const {
        return rows[0] == b.rows[0] && rows[1] == b.rows[1] && rows[2] == b.rows[2];
    }
    constexpr bool operator!=(const Basis& b) const { return !(*this == b); }

private:
    constexpr real_t entry(int row, int column) const {
        const Vector3& r = rows[row];
        return column == 0 ? r.x : (column == 1 ? r.y : r.z);
    }
};

}  // namespace godot
