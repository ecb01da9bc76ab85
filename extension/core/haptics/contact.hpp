// A place where the proxy touches, or nearly touches, a surface.
#pragma once

#include <array>
#include <span>

#include "core/geometry/surface_end.hpp"
#include "core/math/types.hpp"

namespace tactus {

struct Contact {
    Vec3 point{0.0};                      // on the surface, in the world (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};           // unit, from the surface to the proxy's centre, in the world
    Vec3 force_direction{0.0, 1.0, 0.0};  // unit; the normal, or what force shading makes of it, in the world
    double gap = 0.0;  // distance still to the resting distance radius + skin (unit: meters)
    // How the distance bends with the proxy's place: second derivatives along u and cross(normal, u) (unit:
    // 1/meter), and where that ends: ends[first_end] … of the list it is in.
    Vec3 u{1.0, 0.0, 0.0};
    double bend_u = 0.0;
    double bend_v = 0.0;
    int first_end = 0;
    int end_count = 0;
    int body = -1;  // slot in the TouchScene
    double pressure =
        0.0;  // penetration this contact holds back: the force over the stiffness (unit: meters)
};

struct ContactList {
    static constexpr int capacity = 256;
    static constexpr int end_capacity = 512;

    std::array<Contact, capacity> items;
    std::array<SurfaceEnd, end_capacity> ends;  // in the world
    int count = 0;
    int end_count = 0;

    void clear() { count = end_count = 0; }
    // What does not fit is left out: sweeps still see it.
    void add(const Contact& contact) {
        if (count < capacity) {
            items[static_cast<std::size_t>(count++)] = contact;
        }
    }
    void add_end(const SurfaceEnd& end) {
        if (end_count < end_capacity) {
            ends[static_cast<std::size_t>(end_count++)] = end;
        }
    }
    std::span<const Contact> all() const { return {items.data(), static_cast<std::size_t>(count)}; }
    std::span<const SurfaceEnd> ends_of(const Contact& contact) const {
        return {ends.data() + contact.first_end, static_cast<std::size_t>(contact.end_count)};
    }
};

}  // namespace tactus
