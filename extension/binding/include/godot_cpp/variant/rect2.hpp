#pragma once

#include <godot_cpp/variant/rect2i.hpp>
#include <godot_cpp/variant/vector2.hpp>

namespace godot {

struct Rect2 {
    Vector2 position;
    Vector2 size;

    constexpr Rect2() = default;
    constexpr Rect2(const Vector2& p_position, const Vector2& p_size) : position(p_position), size(p_size) {}
    constexpr Rect2(real_t x, real_t y, real_t width, real_t height) : position(x, y), size(width, height) {}
    constexpr Rect2(const Rect2i& rect) : position(rect.position), size(rect.size) {}
    operator String() const;

    constexpr Vector2 get_end() const { return position + size; }
    constexpr Vector2 get_center() const { return position + size * real_t(0.5); }
    constexpr real_t get_area() const { return size.x * size.y; }
    constexpr bool has_point(const Vector2& p) const {
        return p.x >= position.x && p.y >= position.y && p.x < get_end().x && p.y < get_end().y;
    }
    constexpr bool operator==(const Rect2& r) const { return position == r.position && size == r.size; }
    constexpr bool operator!=(const Rect2& r) const { return !(*this == r); }
};

}  // namespace godot
