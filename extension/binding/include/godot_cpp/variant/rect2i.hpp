#pragma once

#include <godot_cpp/variant/vector2i.hpp>

namespace godot {

struct Rect2i {
    Vector2i position;
    Vector2i size;

    constexpr Rect2i() = default;
    constexpr Rect2i(const Vector2i& p_position, const Vector2i& p_size)
        : position(p_position), size(p_size) {}
    constexpr Rect2i(int32_t x, int32_t y, int32_t width, int32_t height)
        : position(x, y), size(width, height) {}
    operator String() const;

    constexpr Vector2i get_end() const { return position + size; }
    constexpr int64_t get_area() const { return static_cast<int64_t>(size.x) * size.y; }
    constexpr bool has_point(const Vector2i& p) const {
        return p.x >= position.x && p.y >= position.y && p.x < get_end().x && p.y < get_end().y;
    }
    constexpr bool operator==(const Rect2i& r) const { return position == r.position && size == r.size; }
    constexpr bool operator!=(const Rect2i& r) const { return !(*this == r); }
};

}  // namespace godot
