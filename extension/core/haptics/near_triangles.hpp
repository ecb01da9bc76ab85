// The few triangles of one part that the proxy touches or nearly touches, and which of them count as
// contacts.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/closest_point_on_triangle.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/haptics/contact.hpp"
#include "core/haptics/touch_scene.hpp"

namespace tactus {

class NearTriangles {
public:
    void clear() { count_ = 0; }
    int count() const { return count_; }

    // Takes in one lane of a pack, lanes in their order; `center` is the proxy's, in the part's frame.
    // Triangles beyond the capacity are left out: sweeps still see them.
    void add(const TriangleTree& tree, std::uint32_t pack, int lane_index, const Vec3& center);

    // An edge or corner counts only where it is nearest to the sphere on every triangle that shares it. Where
    // another triangle contains the same point and is nearer, the surface there is flat or concave seen from
    // the sphere: that triangle's own contact stands for it. Where several share it equally, the first owns
    // it. Decided from the triangles at hand, it needs no adjacency, and holds for T-junctions and soups,
    // from either side. Distances that differ by at most `same` are equal (unit: meters).
    bool is_covered(int index, double same) const;

    // The contact of a sphere whose centre rests at distance `rest` (unit: meters), added to `out`.
    void add_contact(int index, const ScenePart& part, double rest, double same, ContactList& out) const;

private:
    static constexpr int capacity = ContactList::capacity;

    struct Item {
        TriangleClosestPoint closest;
        Vec3 offset;  // from the closest point to the centre
        double distance;
        std::uint32_t id;
        Vec3 a, b, c;
    };

    static Vec3 normal_of(const Item& near);
    void add_ends(const Item& near, const ScenePart& part, double same, ContactList& out) const;

    const Item& item(int index) const { return items_[static_cast<std::size_t>(index)]; }

    std::array<Item, capacity> items_;
    int count_ = 0;
};

}  // namespace tactus
