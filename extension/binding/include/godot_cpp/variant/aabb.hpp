#pragma once

#include <godot_cpp/variant/vector3.hpp>

namespace godot {

struct AABB {
    Vector3 position;
    Vector3 size;

    constexpr AABB() = default;
    constexpr AABB(const Vector3& p_position, const Vector3& p_size) : position(p_position), size(p_size) {}
    operator String() const;

    constexpr Vector3 get_end() const { return position + size; }
    constexpr Vector3 get_center() const { return position + size * real_t(0.5); }
    constexpr real_t get_volume() const { return size.x * size.y * size.z; }
    constexpr bool has_volume() const { return size.x > 0 && size.y > 0 && size.z > 0; }
    constexpr bool has_surface() const { return size.x > 0 || size.y > 0 || size.z > 0; }
    AABB abs() const { return AABB(position + size.min(Vector3()), size.abs()); }
    constexpr bool has_point(const Vector3& p) const {
        const Vector3 end = get_end();
        return p.x >= position.x && p.y >= position.y && p.z >= position.z && p.x <= end.x && p.y <= end.y &&
               p.z <= end.z;
    }
    constexpr bool intersects(const AABB& b) const {
        const Vector3 end = get_end();
        const Vector3 b_end = b.get_end();
        return position.x < b_end.x && end.x > b.position.x && position.y < b_end.y && end.y > b.position.y &&
               position.z < b_end.z && end.z > b.position.z;
    }
    constexpr AABB merge(const AABB& b) const {
        const Vector3 low = position.min(b.position);
        return AABB(low, get_end().max(b.get_end()) - low);
    }
    constexpr AABB expand(const Vector3& p) const {
        const Vector3 low = position.min(p);
        return AABB(low, get_end().max(p) - low);
    }
    constexpr AABB grow(real_t by) const {
        return AABB(position - Vector3(by, by, by), size + Vector3(2 * by, 2 * by, 2 * by));
    }
    constexpr real_t get_longest_axis_size() const { return MAX(size.x, MAX(size.y, size.z)); }
    constexpr real_t get_shortest_axis_size() const { return MIN(size.x, MIN(size.y, size.z)); }
    constexpr bool operator==(const AABB& b) const { return position == b.position && size == b.size; }
    constexpr bool operator!=(const AABB& b) const { return !(*this == b); }
};

}  // namespace godot
