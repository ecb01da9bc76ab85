#include "core/geometry/pack_memory.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace tactus {

namespace {

// A pack that a way may meet, and when at the earliest.
struct Candidate {
    double t;
    std::size_t index;
};

}  // namespace

std::size_t PackMemory::Gathering::index_of(std::uint32_t pack, std::size_t first, std::size_t count) const {
    if (first < count && this->pack(first) == pack) {
        return first;
    }
    for (std::size_t block = 0; block * node_width < count; ++block) {
        if (const unsigned same = lane_bits(FloatMask(packs[block] == pack))) {
            return std::min(count, block * node_width + static_cast<std::size_t>(std::countr_zero(same)));
        }
    }
    return count;
}

void PackMemory::gather(const TriangleTree& tree, const Vec3& center, double radius, double away,
                        double odometer, WorkBudget& work) {
    std::array<FoundPack, capacity> found;
    const FoundPacks packs = tree.packs_around(center, radius, work, found);
    const Gathering& last = gatherings_[now_];
    now_ = 1 - now_;
    Gathering& gathered = gatherings_[now_];
    const std::size_t last_count = std::exchange(count_, packs.count);
    center_ = center;
    radius_ = packs.radius;
    clear_until_.fill(splat(std::numeric_limits<double>::infinity()));
    std::size_t next = 0;  // both gatherings come node by node: after a pack mostly the same one follows
    for (std::size_t i = 0; i < count_; ++i) {
        gathered.packs[i / node_width][i % node_width] = found[i].pack;
        const std::size_t before = last.index_of(found[i].pack, next, last_count);
        if (before < last_count) {
            gathered.seen[i] = last.seen[before];
            next = before + 1;
        } else {
            gathered.seen[i].at = -1.0;
        }
        set_clear(i, odometer + static_cast<double>(found[i].distance) - away);
    }
}

double PackMemory::covered_share(const Vec3& start, const Vec3& motion, double reach) const {
    const double room = radius_ - reach;
    const Vec3 off = start - center_;
    const double inside = room * room - glm::dot(off, off);
    if (room <= 0.0 || inside <= 0.0) {
        return 0.0;
    }
    // |off + share * motion| = room
    const double squared = glm::dot(motion, motion);
    const double along = glm::dot(off, motion);
    return (std::sqrt(along * along + squared * inside) - along) / std::max(squared, 1e-300);
}

const PackMemory::Seen& PackMemory::look_at(std::size_t index, const TriangleTree& tree,
                                            const LanesVec3& point, double odometer) {
    Seen& last = seen(index);
    if (last.at != odometer) {
        const PackOffset offset = offset_from_triangles(tree.pack(pack(index)), point);
        last = {bound_from(offset, point), odometer, lane_bits(offset.is_face)};
    }
    return last;
}

// Tangents from before tell when a pack can be met at the earliest: the earliest are swept first, and end the
// search for most of the others. Each is looked at from the end of the way then: what is learnt there is
// asked again as soon as the sphere has arrived, and mostly leaves no room for a hit on the way.
Hit PackMemory::sweep(const TriangleTree& tree, const SphereWay& way, double limit, double odometer,
                      WorkBudget& work) {
    const double reach = way.distance + way.slack;
    const double length = glm::length(way.motion);
    const LanesVec3 from = splat(way.start);
    const LanesVec3 direction = splat(way.motion);
    std::array<Candidate, capacity> candidates;
    std::size_t count = 0;
    visit_on_way(length * limit, reach, odometer, [&](std::size_t i) {
        const PackBound& at =
            seen(i).at >= 0.0 ? seen(i).tangents : look_at(i, tree, from, odometer).tangents;
        const double t = earliest_below(at, from, direction, reach);
        if (t <= limit) {
            std::size_t place = count++;
            for (; place > 0 && t < candidates[place - 1].t; --place) {
                candidates[place] = candidates[place - 1];
            }
            candidates[place] = {t, i};
        }
    });
    work.spend(static_cast<std::int64_t>(count_ / lane_count + count * cost::pack_look));
    Hit hit;
    hit.t = limit;
    for (std::size_t k = 0; k < count && candidates[k].t <= hit.t; ++k) {
        const auto [earliest, i] = candidates[k];
        if (work.is_gone()) {
            return {earliest, false, false, hit.triangle};
        }
        work.spend(cost::pack_look);
        const LanesVec3 to = splat(way.start + way.motion * hit.t);
        const PackBound before = seen(i).tangents;
        const PackBound& last = look_at(i, tree, to, odometer + length * hit.t).tangents;
        set_clear(i, odometer + smallest(least_distances(last, to)) - length * hit.t);
        if (!may_come_within(before, last, from, to, reach)) {
            continue;
        }
        const PackHit met = sweep_to_triangles(tree.pack(pack(i)), way, hit.t, &last);
        work.spend(met.looks * work.sweep_look());
        if (met.found()) {
            hit.t = met.t;
            hit.found = true;
            hit.triangle = pack(i) * lane_count + static_cast<std::uint32_t>(met.lane);
        }
    }
    return hit;
}

}  // namespace tactus
