// What a proxy remembers about the triangles around it. Consecutive ticks ask almost the same question: the
// packs found in one ball answer for every place until the proxy's own ball leaves it.
//
// Each pack is known by four ever better bounds, and asked only as far as needed: how far the proxy must
// travel before it can touch it; a plane that has the whole pack behind it, found when it was last looked at;
// the tangents of its triangles then, true everywhere and nearly exact while the proxy slides along the
// surface; and its triangles. The first two are held side by side for four packs at once: most packs that are
// near are lateral, and cost no more than that.
//
// Travel is measured by an odometer that only grows: the length of the proxy's path relative to the part.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "core/geometry/triangle_tree.hpp"

namespace tactus {

class Neighbourhood {
public:
    Neighbourhood() = default;
    Neighbourhood(const Neighbourhood&) = delete;
    Neighbourhood& operator=(const Neighbourhood&) = delete;

    // All packs in the ball of the given radius around `center`, for a proxy at `point`. False where they are
    // too many: the neighbourhood is then empty and the tree itself must be asked. Packs up to `soon` from
    // the point are fetched from memory: they will be looked at next.
    bool gather(const TriangleTree& tree, const Vec3& center, double radius, const Vec3& point, double soon,
                double odometer);

    // Empty, for another part.
    void clear() {
        count_ = known_count_ = 0;
        radius_ = -1.0;
    }

    // Every pack is known that is nearer to the point than this (unit: meters). Negative: not even there.
    double covered_around(const Vec3& point) const { return radius_ - glm::distance(point, center_); }
    // The largest share of a way on which every pack within `reach` is known, above 1 where it is more.
    double covered_share(const Vec3& start, const Vec3& motion, double reach) const;

    // Calls visit(index) for every pack that may have a triangle within `limit` of a place between two points
    // that are `length` apart, the proxy being at the first. Returns a lower bound of the distance of all
    // other packs that are known.
    template <class Visit>
    double visit_between(const LanesVec3& from, const LanesVec3& to, double length, double limit,
                         double odometer, Visit&& visit) {
        const double travelled = odometer + length;
        const Lanes near = splat(limit);
        Lanes least = splat(std::numeric_limits<double>::infinity());
        for (std::size_t first = 0; first < count_; first += lane_count) {
            const Block& block = blocks_[first / lane_count];
            // A plane is linear: on a way it is lowest at an end.
            const Lanes above = lanes_min(dot(block.normal, from), dot(block.normal, to)) + block.offset;
            const Lanes bound = lanes_max(above, block.clear_until - splat(travelled));
            const LaneMask reached = bound <= near;
            least = lanes_min(least, select(reached, least, bound));
            for (unsigned left = lane_bits(reached); left != 0; left &= left - 1) {
                visit(first + static_cast<std::size_t>(std::countr_zero(left)));
            }
        }
        return smallest(least);
    }

    std::uint32_t pack(std::size_t index) const { return packs_[index].pack; }

    // Lower bounds of the distances of its triangles from `point`, where the proxy is: from their tangents
    // where that is enough to see that they are farther than `limit`, from the triangles otherwise. Exact in
    // the latter case.
    Lanes distances(std::size_t index, const TriangleTree& tree, const LanesVec3& point, double limit,
                    double odometer) {
        if (packs_[index].known >= 0) {
            const Lanes least = least_distances(tangents_of(packs_[index]), point);
            if (!any(least <= splat(limit))) {
                set_clear(index, odometer + smallest(least));
                return least;
            }
        }
        return look_at(index, tree, point, odometer);
    }

    // False where no triangle of the pack can be within `limit` of any place between two points that are
    // `length` apart; the proxy is at the first.
    bool may_meet(std::size_t index, const TriangleTree& tree, const LanesVec3& from, const LanesVec3& to,
                  double length, double limit, double odometer);

private:
    static constexpr std::size_t capacity = 768;
    static constexpr std::size_t known_capacity = 192;

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

    // The exact distances from `point`, where the proxy is at that odometer reading.
    Lanes look_at(std::size_t index, const TriangleTree& tree, const LanesVec3& point, double odometer);

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
    static constexpr std::size_t table_size = 512;  // a power of two, above twice known_capacity
    struct Entry {
        std::uint32_t pack;
        std::int32_t known;
    };
    std::array<Entry, table_size> table_;
    Knowledge* old_known_ = &both_[1];
};

}  // namespace tactus
