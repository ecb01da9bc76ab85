// What is remembered about the triangles around a sphere. Consecutive ticks ask almost the same question: the
// packs found in one ball answer for every place until the sphere's own ball leaves it.
//
// Each pack is known by four ever better bounds, and asked only as far as needed: how far the sphere must
// travel before it can touch it; a plane that has the whole pack behind it, found when it was last looked at;
// the tangents of its triangles then, true everywhere and nearly exact while the sphere slides along the
// surface; and its triangles. The first two are held side by side for four packs at once: most packs that are
// near are lateral, and cost no more than that.
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
    PackMemory() = default;
    PackMemory(const PackMemory&) = delete;
    PackMemory& operator=(const PackMemory&) = delete;

    static constexpr std::size_t capacity = 256;

    // All packs in the ball of the given radius around `center`, for a sphere at `point`. False where they
    // are too many: nothing is then remembered, and the tree itself must be asked. Packs up to `soon` from
    // the point are fetched from memory: they will be looked at next.
    bool gather(const TriangleTree& tree, const Vec3& center, double radius, const Vec3& point, double soon,
                double odometer, WorkBudget& work);

    // Empty, for another mesh.
    void clear() {
        count_ = known_count_ = 0;
        radius_ = -1.0;
    }
    std::size_t count() const { return count_; }

    // Every pack is known that is nearer to the point than this (unit: meters). Negative: not even there.
    double covered_around(const Vec3& point) const { return radius_ - glm::distance(point, center_); }
    // The largest share of a way on which every pack within `reach` is known, above 1 where it is more.
    double covered_share(const Vec3& start, const Vec3& motion, double reach) const;

    // As TriangleTree::visit_near for the packs that are known, with what is seen of each:
    // visit(pack, tangents, distances). Returns a lower bound of the distances of the others.
    template <class Visit>
    double visit_near(const TriangleTree& tree, const Vec3& point, const double& limit, double odometer,
                      WorkBudget& work, Visit&& visit);

    // As TriangleTree::sweep, for the packs that are known.
    Hit sweep(const TriangleTree& tree, const SphereWay& way, double limit, double odometer,
              WorkBudget& work);

private:
    static constexpr std::size_t known_capacity = 128;

    struct Remembered {
        std::uint32_t pack;
        std::int32_t known;  // what is known from a look, -1: nothing
        double looked_at;    // odometer reading at that look
    };
    // Of a pack that has been looked at.
    struct Known {
        PackBound tangents;
        PackPlane plane;
    };
    // Of four packs: no triangle is nearer to x than normal . x + offset, nor than clear_until - odometer.
    struct Block {
        LanesVec3 normal;
        Lanes offset;       // (unit: meters)
        Lanes clear_until;  // odometer + distance (unit: meters); infinite beyond count_
    };
    // A pack that a way may meet, and when at the earliest.
    struct Candidate {
        double t;
        std::uint32_t index;
    };

    // Calls visit(index) for every pack that may have a triangle within `limit` of a place between two points
    // that are `length` apart, the sphere being at the first. Returns a lower bound of the distance of all
    // other packs that are known.
    template <class Visit>
    double visit_between(const LanesVec3& from, const LanesVec3& to, double length, const double& limit,
                         double odometer, Visit&& visit);
    // The tangents at `point`, where the sphere is at that odometer reading.
    PackBound look_at(std::size_t index, const TriangleTree& tree, const LanesVec3& point, double odometer);
    // False where no triangle of the pack can be within `limit` of any place between two points that are
    // `length` apart; the sphere is at the first.
    bool may_meet(std::size_t index, const TriangleTree& tree, const LanesVec3& from, const LanesVec3& to,
                  double length, double limit, double odometer);

    void set_clear(std::size_t index, double until) {
        blocks_[index / lane_count].clear_until[index % lane_count] = until;
    }
    void set_plane(std::size_t index, const PackPlane& plane);
    PackBound& tangents_of(const Remembered& remembered) {
        return (*known_)[static_cast<std::size_t>(remembered.known)].tangents;
    }
    void remember_known();
    std::int32_t remembered(std::uint32_t pack) const;

    std::array<Block, capacity / lane_count> blocks_;
    std::array<Remembered, capacity> packs_;
    using Knowledge = std::array<Known, known_capacity>;
    Knowledge both_[2];
    Knowledge* known_ = &both_[0];
    std::size_t count_ = 0;
    std::size_t known_count_ = 0;
    Vec3 center_{0.0};
    double radius_ = -1.0;

    // Of the last gathering, by pack: what was learnt then is still true.
    static constexpr std::size_t table_size = 256;  // a power of two, twice known_capacity
    struct Entry {
        std::uint32_t pack;
        std::int32_t known;
    };
    std::array<Entry, table_size> table_;
    Knowledge* old_known_ = &both_[1];
};

template <class Visit>
double PackMemory::visit_between(const LanesVec3& from, const LanesVec3& to, double length,
                                 const double& limit, double odometer, Visit&& visit) {
    const double travelled = odometer + length;
    Lanes least = splat(std::numeric_limits<double>::infinity());
    for (std::size_t first = 0; first < count_; first += lane_count) {
        const Block& block = blocks_[first / lane_count];
        // A plane is linear: on a way it is lowest at an end.
        const Lanes above = lanes_min(dot(block.normal, from), dot(block.normal, to)) + block.offset;
        const Lanes bound = lanes_max(above, block.clear_until - splat(travelled));
        const LaneMask reached = bound <= splat(limit);
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
    const double others = visit_between(center, center, 0.0, limit, odometer, [&](std::size_t i) {
        work.spend(cost::pack_look);
        if (packs_[i].known >= 0) {
            const double least = smallest(least_distances(tangents_of(packs_[i]), center));
            if (least > limit) {
                set_clear(i, odometer + least);
                passed_by = std::min(passed_by, least);
                return;
            }
        }
        const PackBound tangents = look_at(i, tree, center, odometer);
        const Lanes distances = least_distances(tangents, center);
        passed_by = std::min(passed_by, smallest(distances));
        visit(packs_[i].pack, tangents, distances);
    });
    return std::min(others, passed_by);
}

}  // namespace tactus
