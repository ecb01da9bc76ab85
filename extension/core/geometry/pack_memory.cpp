#include "core/geometry/pack_memory.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <utility>

namespace tactus {

namespace {

// A pack that a way may meet, and when at the earliest.
struct Candidate {
    double t;
    std::size_t index;

    auto operator<=>(const Candidate&) const = default;
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
    gathered.looked_at = 0;
    std::size_t next = 0;  // both gatherings come node by node: after a pack mostly the same one follows
    for (std::size_t i = 0; i < count_; ++i) {
        gathered.packs[i / node_width][i % node_width] = found[i].pack;
        const std::size_t before = last.index_of(found[i].pack, next, last_count);
        if (before < last_count) {
            gathered.seen[i] = last.seen[before];
            gathered.looked_at |= (last.looked_at >> before & 1) << i;
            next = before + 1;
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

PackMemory::NearPacks PackMemory::near_way(double length, double limit, double odometer) const {
    const Lanes travelled = splat(odometer + length);
    const Lanes none = splat(std::numeric_limits<double>::infinity());
    Lanes others = none;
    PackSet near = 0;
    for (std::size_t first = 0; first < count_; first += lane_count) {
        const Lanes bound = clear_until_[first / lane_count] - travelled;
        const LaneMask reached = (bound <= splat(limit)) & (bound < none);  // no limit has none beyond count_
        others = lanes_min(others, select(reached, none, bound));
        near |= PackSet{lane_bits(reached)} << first;
    }
    return {near, smallest(others)};
}

const PackMemory::Seen& PackMemory::look_at(std::size_t index, const TriangleTree& tree,
                                            const LanesVec3& point, double odometer) {
    Seen& last = seen(index);
    PackSet& looked_at = gatherings_[now_].looked_at;
    if (last.at != odometer || (looked_at >> index & 1) == 0) {
        const PackOffset offset = tree.offset_from_pack(pack(index), point);
        last.tangents = bound_from(offset, point);
        last.at = odometer;
        last.faces = lane_bits(offset.is_face);
        looked_at |= PackSet{1} << index;
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
    const LanesVec3 whole = splat(way.motion * limit);
    const PackSet near = near_way(length * limit, reach, odometer).packs;
    visit_each(near & ~gatherings_[now_].looked_at, [&](std::size_t i) { look_at(i, tree, from, odometer); });
    PackSet reached = 0;
    visit_each(near, [&](std::size_t i) {
        reached |= PackSet{comes_below(seen(i).tangents, from, whole, reach)} << i;
    });
    std::array<Candidate, capacity> candidates;
    std::size_t count = 0;
    visit_each(reached, [&](std::size_t i) {
        candidates[count++] = {earliest_below(seen(i).tangents, from, direction, reach), i};
    });
    std::sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count));
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
        TrianglePack room;
        const PackHit met = sweep_to_triangles(tree.pack(pack(i), room), way, hit.t, &last);
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
