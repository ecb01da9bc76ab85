#pragma once

#include <godot_cpp/variant/transform3d.hpp>
#include <godot_cpp/variant/vector4.hpp>

namespace godot {

// A 4 × 4 matrix, stored by columns.
struct Projection {
    Vector4 columns[4] = {Vector4(1, 0, 0, 0), Vector4(0, 1, 0, 0), Vector4(0, 0, 1, 0), Vector4(0, 0, 0, 1)};

    constexpr Projection() = default;
    constexpr Projection(const Vector4& x, const Vector4& y, const Vector4& z, const Vector4& w)
        : columns{x, y, z, w} {}
    constexpr Projection(real_t xx, real_t xy, real_t xz, real_t xw, real_t yx, real_t yy, real_t yz,
                         real_t yw, real_t zx, real_t zy, real_t zz, real_t zw, real_t wx, real_t wy,
                         real_t wz, real_t ww)
        : columns{Vector4(xx, xy, xz, xw), Vector4(yx, yy, yz, yw), Vector4(zx, zy, zz, zw),
                  Vector4(wx, wy, wz, ww)} {}
    operator String() const;

    Vector4& operator[](int column) { return columns[column]; }
    const Vector4& operator[](int column) const { return columns[column]; }
    constexpr Vector4 xform(const Vector4& v) const {
        return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z + columns[3] * v.w;
    }
    constexpr Vector4 operator*(const Vector4& v) const { return xform(v); }
    constexpr Projection operator*(const Projection& p) const {
        return {xform(p.columns[0]), xform(p.columns[1]), xform(p.columns[2]), xform(p.columns[3])};
    }
    constexpr bool operator==(const Projection& p) const {
        return columns[0] == p.columns[0] && columns[1] == p.columns[1] && columns[2] == p.columns[2] &&
               columns[3] == p.columns[3];
    }
    constexpr bool operator!=(const Projection& p) const { return !(*this == p); }
};

}  // namespace godot
