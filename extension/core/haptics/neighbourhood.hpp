// What a proxy remembers about the triangles around it. Consecutive ticks ask almost the same question: the
// packs found within `reach` of one place answer for every place until the proxy has travelled out of them.
//
// Each pack is known by three ever better bounds, and asked only as far as needed: how far the proxy must
// travel before it can touch it; a tangent plane, true everywhere and nearly exact while the proxy slides
// along the surface; and its triangles.
//
// Travel is measured by an odometer that only grows: the length of the proxy's path relative to the part.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/geometry/triangle_tree.hpp"

namespace tactus {

class Neighbourhood {
public:
    Neighbourhood() = default;
    Neighbourhood(const Neighbourhood&) = delete;
    Neighbourhood& operator=(const Neighbourhood&) = delete;

    // False where too many packs lie within reach: the neighbourhood is then empty and the tree itself must
    // be asked. Packs up to `soon` are fetched from memory: they will be looked at next.
    bool gather(const TriangleTree& tree, const Vec3& point, double reach, double soon, double odometer);

    // Empty, for another part.
    void clear() {
        count_ = bound_count_ = 0;
        covered_until_ = -1.0;
    }

    // Odometer + distance up to which every pack is known (unit: meters).
    double covered_until() const { return covered_until_; }

    // Calls visit(index) for every pack that may have a triangle within `limit` of a place that the proxy can
    // have come to by now. Returns a lower bound of the distance of all others.
    template <class Visit>
    double visit_within(double limit, double odometer, Visit&& visit) {
        const Lanes nearer = splat(odometer + limit);
        Lanes least = splat(covered_until_);
        for (std::size_t block = 0; block < count_; block += lane_count) {
            Lanes& clear_until = clear_until_[block / lane_count];
            const unsigned near = lane_bits(clear_until <= nearer);
            least = lanes_min(least, select(clear_until <= nearer, least, clear_until));
            for (unsigned left = near; left != 0; left &= left - 1) {
                visit(block + static_cast<std::size_t>(std::countr_zero(left)));
            }
        }
        return smallest(least) - odometer;
    }

    std::uint32_t pack(std::size_t index) const { return packs_[index].pack; }

    // Lower bounds of the distances of its triangles from `point`: from the tangent plane where that is
    // enough to see that they are farther than `limit`, from the triangles otherwise. Exact in the latter
    // case.
    Lanes distances(std::size_t index, const TriangleTree& tree, const LanesVec3& point, double limit,
                    double odometer) {
        if (packs_[index].bound >= 0) {
            const Lanes least = least_distances(bound_of(packs_[index]), point);
            if (!any(least <= splat(limit))) {
                set_clear(index, odometer + smallest(least));
                return least;
            }
        }
        return look_at(index, tree, point, odometer);
    }

    // The exact distances from `point`, where the proxy is at that odometer reading.
    Lanes look_at(std::size_t index, const TriangleTree& tree, const LanesVec3& point, double odometer) {
        Remembered& remembered = packs_[index];
        if (remembered.bound >= 0 && remembered.looked_at == odometer) {
            return least_distances(bound_of(remembered), point);
        }
        const PackBound bound = bound_from(offset_from_triangles(tree.pack(remembered.pack), point), point);
        if (remembered.bound < 0 && bound_count_ < bound_capacity) {
            remembered.bound = static_cast<std::int32_t>(bound_count_++);
        }
        if (remembered.bound >= 0) {
            bound_of(remembered) = bound;
            remembered.looked_at = odometer;
        }
        const Lanes exact = least_distances(bound, point);
        set_clear(index, odometer + smallest(exact));
        return exact;
    }

    // False where no triangle of the pack can be within `limit` of any place between two points, as far as is
    // known without a look.
    bool may_meet(std::size_t index, const LanesVec3& from, const LanesVec3& to, double limit) {
        if (packs_[index].bound < 0) {
            return true;
        }
        // Bounds are linear: a pack that neither end of the way can touch is not touched between them.
        const PackBound& bound = bound_of(packs_[index]);
        return any(lanes_min(least_distances(bound, from), least_distances(bound, to)) <= splat(limit));
    }

private:
    static constexpr std::size_t capacity = 768;
    static constexpr std::size_t bound_capacity = 192;

    struct Remembered {
        std::uint32_t pack;
        std::int32_t bound;  // its tangent plane, -1: not known
        double looked_at;    // odometer reading at which that was found
    };

    // Odometer + distance: the pack is no nearer than this less the odometer (unit: meters).
    void set_clear(std::size_t index, double until) {
        clear_until_[index / lane_count][index % lane_count] = until;
    }
    PackBound& bound_of(const Remembered& remembered) {
        return (*bounds_)[static_cast<std::size_t>(remembered.bound)];
    }
    void remember_bounds();
    std::int32_t remembered_bound(std::uint32_t pack) const;

    std::array<Lanes, capacity / lane_count> clear_until_;  // infinite beyond count_
    std::array<Remembered, capacity> packs_;
    using Bounds = std::array<PackBound, bound_capacity>;
    Bounds both_[2];
    Bounds* bounds_ = &both_[0];
    std::size_t count_ = 0;
    std::size_t bound_count_ = 0;
    double covered_until_ = -1.0;

    // Of the last gathering, by pack: what was learnt then is still true.
    static constexpr std::size_t table_size = 512;  // a power of two, above twice bound_capacity
    struct Entry {
        std::uint32_t pack;
        std::int32_t bound;
    };
    std::array<Entry, table_size> table_;
    Bounds* old_bounds_ = &both_[1];
};

}  // namespace tactus
