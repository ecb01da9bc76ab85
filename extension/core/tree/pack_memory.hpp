// What is remembered about the triangles around a sphere. Consecutive ticks ask almost the same question: the
// packs found around one place answer for every place until the sphere's own ball leaves what they cover.
//
// Of each pack is known how far the sphere must travel before it can touch it, and from when it was last
// looked at a plane that it lies behind, and the tangents of its triangles: true everywhere, and nearly exact
// while the sphere slides along the surface. Most questions end at the planes, which four packs at once are
// asked for.
//
// Travel is measured by an odometer that only grows: the length of the sphere's path relative to the mesh.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "core/tree/triangle_tree.hpp"

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
    // visit(pack, normals, distances, faces), the last as lane_bits() of PackOffset::is_face. Returns a lower
    // bound of the distances of the others.
    template <class Visit>
    double visit_near(const TriangleTree& tree, const Vec3& point, const double& limit, double odometer,
                      WorkBudget& work, Visit&& visit);

    // As TriangleTree::sweep, for the packs that are known.
    Hit sweep(const TriangleTree& tree, const SphereWay& way, double limit, double odometer,
              WorkBudget& work);

private:
    struct Seen {
        PackBound tangents;
        double at = 0.0;     // odometer reading at that look
        unsigned faces = 0;  // then, see visit_near
    };
    // Packs by a bit each.
    using PackSet = std::uint64_t;
    static_assert(capacity <= std::numeric_limits<PackSet>::digits);
    using PackNumbers = std::uint32_t __attribute__((vector_size(4 * node_width)));
    struct Gathering {
        std::array<PackNumbers, capacity / node_width> packs{};
        std::array<Seen, capacity> seen;
        std::array<PackBound, capacity / lane_count> planes;  // with a pack in each lane
        PackSet looked_at = 0;

        std::uint32_t pack(std::size_t index) const { return packs[index / node_width][index % node_width]; }
        // Where that pack stands among the first `count`, looked for from `first` on; `count` where it does
        // not.
        std::size_t index_of(std::uint32_t pack, std::size_t first, std::size_t count) const;
    };

    std::uint32_t pack(std::size_t index) const { return gatherings_[now_].pack(index); }
    Seen& seen(std::size_t index) { return gatherings_[now_].seen[index]; }
    struct NearPacks {
        PackSet packs = 0;
        double others = 0.0;  // a lower bound of the distance of all others that are known (unit: meters)
    };
    // Those that may have a triangle within `limit` of a place on a way, as travel and planes tell.
    NearPacks near_way(const LanesVec3& from, const LanesVec3& motion, double length, double limit,
                       double odometer);
    template <class Visit>
    static void visit_each(PackSet packs, Visit&& visit) {
        for (; packs != 0; packs &= packs - 1) {
            visit(static_cast<std::size_t>(std::countr_zero(packs)));
        }
    }
    // As it is seen from `point`, where the sphere is once its odometer has that reading.
    const Seen& look_at(std::size_t index, const TriangleTree& tree, const LanesVec3& point, double odometer);
    // Whether what may be within the limit are faces that it was seen above, and still is: their tangents are
    // their planes.
    bool still_holds(std::size_t index, const TriangleTree& tree, const LanesVec3& point, double limit,
                     double odometer);
    double clear_until(std::size_t index) const {
        return clear_until_[index / lane_count][index % lane_count];
    }
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

// All that branches ask for is computed before: one that is guessed wrong waits for nothing then. What seems
// nearest is first, so that less is left within the limit.
template <class Visit>
double PackMemory::visit_near(const TriangleTree& tree, const Vec3& point, const double& limit,
                              double odometer, WorkBudget& work, Visit&& visit) {
    const LanesVec3 center = splat(point);
    auto [near, others] = near_way(center, splat(Vec3(0.0)), 0.0, limit, odometer);
    work.spend(static_cast<std::int64_t>(count_ / (4 * lane_count)) + std::popcount(near) / 2);
    std::size_t next = static_cast<std::size_t>(std::countr_zero(near));
    double nearest = std::numeric_limits<double>::infinity();
    visit_each(near & gatherings_[now_].looked_at, [&](std::size_t i) {
        const double least = smallest(least_distances(seen(i).tangents, center));
        set_clear(i, odometer + least);
        next = least < nearest ? i : next;
        nearest = std::min(nearest, least);
    });
    for (PackSet left = near; left != 0; next = static_cast<std::size_t>(std::countr_zero(left))) {
        left &= ~(PackSet{1} << next);
        if (const double least = clear_until(next) - odometer; least > limit) {
            others = std::min(others, least);
            continue;
        }
        work.spend(cost::pack_look);
        const Seen& look = still_holds(next, tree, center, limit, odometer)
                               ? seen(next)
                               : look_at(next, tree, center, odometer);
        const Lanes distances = least_distances(look.tangents, center);
        set_clear(next, odometer + smallest(distances));
        visit(pack(next), look.tangents.normal, distances, look.faces);
    }
    return others;
}

}  // namespace tactus
