// Places where a sphere touches, or nearly touches, a surface: what holds it back next, and what does.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "core/geometry/surface_end.hpp"
#include "core/math/types.hpp"
#include "core/tree/hit.hpp"

namespace tactus {

// What of a scene is touched: a part, and a triangle of it by its slot in the tree.
struct FeatureId {
    std::uint32_t part = 0;
    std::uint32_t triangle = Hit::no_triangle;  // none: a shape in closed form

    bool operator==(const FeatureId&) const = default;
};

enum class ContactState : std::uint8_t {
    seen,     // as the search found it: good enough to tell which contacts hold the sphere back
    face,     // flat: of a triangle or a shape in closed form, which a search tells as well as a close look
    edge,     // looked at closely: of a triangle
    corner,   // likewise
    solid,    // of a shape in closed form, where it bends
    covered,  // an edge or corner for which a nearer or earlier contact stands
};

struct Contact {
    Vec3 normal{0.0, 1.0, 0.0};  // unit, from the surface to the sphere's centre, in the world
    double gap = 0.0;            // distance still to the resting distance (unit: meters)
    FeatureId feature;
    ContactState state = ContactState::seen;
    std::uint8_t edge = 0;  // of the triangle where state is edge: from this corner to the next
};

struct ContactList {
    static constexpr int capacity = 128;

    std::array<Contact, capacity> items;
    int count = 0;

    void clear() { count = 0; }
    bool is_full() const { return count == capacity; }
    // Where there is no room the farthest goes. Sweeps still see it, and name it if it stops them.
    void add(const Contact& contact) {
        if (!is_full()) {
            items[static_cast<std::size_t>(count++)] = contact;
            return;
        }
        Contact& farthest = *std::ranges::max_element(items, {}, &Contact::gap);
        if (contact.gap < farthest.gap) {
            farthest = contact;
        }
    }
    // Infinite where there is no contact (unit: meters).
    double min_gap() const {
        double least = std::numeric_limits<double>::infinity();
        for (const Contact& contact : all()) {
            least = std::min(least, contact.gap);
        }
        return least;
    }
    Contact& operator[](int index) { return items[static_cast<std::size_t>(index)]; }
    const Contact& operator[](int index) const { return items[static_cast<std::size_t>(index)]; }
    std::span<const Contact> all() const { return {items.data(), static_cast<std::size_t>(count)}; }
};

// How the distance bends with the sphere's place, found for the contacts that press: second derivatives along
// u and cross(normal, u), and where the bent piece of the surface ends.
struct Curvature {
    static constexpr int max_ends = 32;  // those beyond are left out: the piece then seems to go on

    Curvature() {}  // leaves the ends as they are

    Vec3 u{1.0, 0.0, 0.0};                  // unit, perpendicular to the normal, in the world
    double bend_u = 0.0;                    // (unit: 1/meter)
    double bend_v = 0.0;                    // (unit: 1/meter)
    std::array<SurfaceEnd, max_ends> ends;  // in the world
    int end_count = 0;

    bool is_flat() const { return bend_u <= 0.0 && bend_v <= 0.0; }
    void add_end(const SurfaceEnd& end) {
        if (end_count < max_ends) {
            ends[static_cast<std::size_t>(end_count++)] = end;
        }
    }
};

// A contact that holds the sphere back, as forces and effects need it.
struct Touch {
    Vec3 point{0.0};                      // on the surface, in the world (unit: meters)
    Vec3 normal{0.0, 1.0, 0.0};           // unit, from the surface to the sphere's centre, in the world
    Vec3 force_direction{0.0, 1.0, 0.0};  // unit; the normal, or what force shading makes of it, in the world
    double pressure = 0.0;  // penetration it holds back: the force over the stiffness (unit: meters)
    int body = -1;          // slot in the TouchScene
    FeatureId feature;      // of the scene, now
};

struct TouchList {
    static constexpr int capacity = 3;  // three planes fix a point

    std::array<Touch, capacity> items;
    int count = 0;

    void clear() { count = 0; }
    Touch& add() { return items[static_cast<std::size_t>(count++)]; }
    std::span<const Touch> all() const { return {items.data(), static_cast<std::size_t>(count)}; }
};

}  // namespace tactus
