#pragma once

#include <godot_cpp/variant/rect2.hpp>
#include <godot_cpp/variant/vector2.hpp>

namespace godot {

// Stored by columns: x axis, y axis, origin.
struct Transform2D {
    Vector2 columns[3] = {Vector2(1, 0), Vector2(0, 1), Vector2(0, 0)};

    constexpr Transform2D() = default;
    constexpr Transform2D(const Vector2& x, const Vector2& y, const Vector2& origin)
        : columns{x, y, origin} {}
    constexpr Transform2D(real_t xx, real_t xy, real_t yx, real_t yy, real_t ox, real_t oy)
        : columns{Vector2(xx, xy), Vector2(yx, yy), Vector2(ox, oy)} {}
    Transform2D(real_t angle, const Vector2& origin)
        : columns{Vector2(std::cos(angle), std::sin(angle)), Vector2(-std::sin(angle), std::cos(angle)),
                  origin} {}
    operator String() const;

    Vector2& operator[](int column) { return columns[column]; }
    const Vector2& operator[](int column) const { return columns[column]; }
    constexpr const Vector2& get_origin() const { return columns[2]; }
    constexpr Vector2 basis_xform(const Vector2& v) const { return columns[0] * v.x + columns[1] * v.y; }
    constexpr Vector2 xform(const Vector2& p) const { return basis_xform(p) + columns[2]; }
    constexpr Vector2 operator*(const Vector2& p) const { return xform(p); }
    constexpr Transform2D operator*(const Transform2D& t) const {
        return {basis_xform(t.columns[0]), basis_xform(t.columns[1]), xform(t.columns[2])};
    }
    constexpr bool operator==(const Transform2D& t) const {
        return columns[0] == t.columns[0] && columns[1] == t.columns[1] && columns[2] == t.columns[2];
    }
    constexpr bool operator!=(const Transform2D& t) const { return !(*this == t); }
};

}  // namespace godot
