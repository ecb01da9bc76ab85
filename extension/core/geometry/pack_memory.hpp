// What is remembered about the triangles around a sphere. Consecutive ticks ask almost the same question: the
// packs found around one place answer for every place until the sphere's own ball leaves what they cover.
//
// Of each pack is known how far the sphere must travel before it can touch it, and the tangents of its
// triangles when it was last looked at: true everywhere, and nearly exact while the sphere slides along the
// surface. Most questions end there.
//
// Travel is measured by an odometer that only grows: the length of the sphere's path relative to the mesh.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "core/geometry/triangle_tree.hpp"

namespace tactus {

class PackMemory {
public:
    static constexpr std::size_t capacity = 64;

    // The packs nearest to `center`, up to `radius` or as many as fit. The sphere is `away` from the center
    // at most, at that reading of its odometer (unit: meters).
    void gather(const TriangleTree& tree, const Vec3& center, double radius, double away, double odometer,
                WorkBudget& work);
    // Empty, for another mesh.
    void clear() {
        count_ = 0;
        radius_ = -1.0;
    }

    // Every pack is known that is nearer to the point than this (unit: meters). Negative: not even there.
    double covered_around(const Vec3& point) const { return radius_ - glm::distance(point, center_); }
    // The largest share of a way on which every pack within `reach` is known, above 1 where it is more.
    double covered_share(const Vec3& start, const Vec3& motion, double reach) const;

    // As TriangleTree::visit_near for the packs that are known, with what is seen of each:
    // visit(pack, tangents, faces), the last as lane_bits() of PackOffset::is_face. Returns a lower bound of
    // the distances of the others.
    template <class Visit>
    double visit_near(const TriangleTree& tree, const Vec3& point, const double& limit, double odometer,
                      WorkBudget& work, Visit&& visit);

    // As TriangleTree::sweep, for the packs that are known.
    Hit sweep(const TriangleTree& tree, const SphereWay& way, double limit, double odometer,
              WorkBudget& work);

private:
    struct Seen {
        PackBound tangents;
        double at = -1.0;    // odometer reading at that look; below 0: none yet
        unsigned faces = 0;  // then, see visit_near
    };
    using PackNumbers = std::uint32_t __attribute__((vector_size(4 * node_width)));
    struct Gathering {
        std::array<PackNumbers, capacity / node_width> packs{};
        std::array<Seen, capacity> seen;

        std::uint32_t pack(std::size_t index) const { return packs[index / node_width][index % node_width]; }
        // Where that pack stands among the first `count`, looked for from `first` on; `count` where it does
        // not.
        std::size_t index_of(std::uint32_t pack, std::size_t first, std::size_t count) const;
    };

    std::uint32_t pack(std::size_t index) const { return gatherings_[now_].pack(index); }
    Seen& seen(std::size_t index) { return gatherings_[now_].seen[index]; }
    // Calls visit(index) for every pack that may have a triangle within `limit` of a place on a way of that
    // length. Returns a lower bound of the distance of all other packs that are known.
    template <class Visit>
    double visit_on_way(double length, const double& limit, double odometer, Visit&& visit) const;
    // As it is seen from `point`, where the sphere is once its odometer has that reading.
    const Seen& look_at(std::size_t index, const TriangleTree& tree, const LanesVec3& point, double odometer);
    void set_clear(std::size_t index, double until) {
        clear_until_[index / lane_count][index % lane_count] = until;
    }

    std::size_t count_ = 0;
    Vec3 center_{0.0};
    double radius_ = -1.0;
    std::array<Lanes, capacity / lane_count> clear_until_;  // odometer + distance; infinite beyond count_
    Gathering gatherings_[2];  // the last one, and that before: what was seen then still holds
    int now_ = 0;
};

template <class Visit>
double PackMemory::visit_on_way(double length, const double& limit, double odometer, Visit&& visit) const {
    const Lanes travelled = splat(odometer + length);
    const Lanes none = splat(std::numeric_limits<double>::infinity());
    Lanes least = none;
    for (std::size_t first = 0; first < count_; first += lane_count) {
        const Lanes bound = clear_until_[first / lane_count] - travelled;
        const LaneMask reached = (bound <= splat(limit)) & (bound < none);  // no limit has none beyond count_
        least = lanes_min(least, select(reached, least, bound));
        for (unsigned left = lane_bits(reached); left != 0; left &= left - 1) {
            visit(first + static_cast<std::size_t>(std::countr_zero(left)));
        }
    }
    return smallest(least);
}

template <class Visit>
double PackMemory::visit_near(const TriangleTree& tree, const Vec3& point, const double& limit,
                              double odometer, WorkBudget& work, Visit&& visit) {
    const LanesVec3 center = splat(point);
    double passed_by = std::numeric_limits<double>::infinity();
    const double others = visit_on_way(0.0, limit, odometer, [&](std::size_t i) {
        work.spend(cost::pack_look);
        if (seen(i).at >= 0.0) {
            const double least = smallest(least_distances(seen(i).tangents, center));
            if (least > limit) {
                set_clear(i, odometer + least);
                passed_by = std::min(passed_by, least);
                return;
            }
        }
        const Seen& look = look_at(i, tree, center, odometer);
        set_clear(i, odometer + smallest(least_distances(look.tangents, center)));
        visit(pack(i), look.tangents, look.faces);
    });
    return std::min(others, passed_by);
}

}  // namespace tactus
