#include "core/tree/pack_memory.hpp"

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

constexpr double never = std::numeric_limits<double>::infinity();

// Tells nothing, of four packs.
const PackBound no_planes{splat(Vec3(0.0)), splat(-never)};

void copy_lane(const PackBound& from, std::size_t lane, PackBound& to, std::size_t to_lane) {
    to.normal.x[to_lane] = from.normal.x[lane];
    to.normal.y[to_lane] = from.normal.y[lane];
    to.normal.z[to_lane] = from.normal.z[lane];
    to.offset[to_lane] = from.offset[lane];
}

void put_lane(const FoundPack& found, const Vec3& center, double lost, PackBound& planes, std::size_t lane) {
    const Vec3 normal(found.normal[0], found.normal[1], found.normal[2]);
    planes.normal.x[lane] = normal.x;
    planes.normal.y[lane] = normal.y;
    planes.normal.z[lane] = normal.z;
    planes.offset[lane] = static_cast<double>(found.distance) - glm::dot(normal, center) - lost;
}

// The tangent of the nearest triangle of a pack, put where all of the pack lies behind it.
PackBound plane_before(const TrianglePack& pack, const PackBound& tangents, int nearest) {
    const LanesVec3 normal = splat(lane(tangents.normal, nearest));
    const Lanes depth =
        lanes_min(lanes_min(-dot(normal, pack.a), -dot(normal, pack.b)), -dot(normal, pack.c));
    return {normal, splat(smallest(depth))};
}

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
    clear_until_.fill(splat(never));
    gathered.looked_at = 0;
    const double lost = 4e-6 * radius;  // of a found plane's height by how it is turned, wherever it is asked
    std::size_t next = 0;  // both gatherings come node by node: after a pack mostly the same one follows
    for (std::size_t i = 0; i < count_; ++i) {
        PackBound& planes = gathered.planes[i / lane_count];
        if (i % lane_count == 0) {
            planes = no_planes;
        }
        gathered.packs[i / node_width][i % node_width] = found[i].pack;
        const std::size_t before = last.index_of(found[i].pack, next, last_count);
        next = before < last_count ? before + 1 : next;
        if (before < last_count && (last.looked_at >> before & 1) != 0) {
            gathered.seen[i] = last.seen[before];
            gathered.looked_at |= PackSet{1} << i;
            copy_lane(last.planes[before / lane_count], before % lane_count, planes, i % lane_count);
        } else {
            put_lane(found[i], center, lost, planes, i % lane_count);
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

PackMemory::NearPacks PackMemory::near_way(const LanesVec3& from, const LanesVec3& motion, double length,
                                           double limit, double odometer) {
    const Lanes none = splat(never), farthest = splat(limit);
    Lanes others = none;
    PackSet near = 0;
    for (std::size_t first = 0; first < count_; first += lane_count) {
        const PackBound& planes = gatherings_[now_].planes[first / lane_count];
        Lanes& clear_until = clear_until_[first / lane_count];
        const Lanes start = least_distances(planes, from);
        clear_until = lanes_max(clear_until, splat(odometer) + start);
        const Lanes bound = clear_until - splat(odometer + length);
        const LaneMask reached = (bound <= farthest) & (lowest_on_way(planes, start, motion) <= farthest) &
                                 (bound < none);  // no limit has none beyond count_
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
        TrianglePack room;
        const TrianglePack& triangles = tree.pack(pack(index), room);
        const PackOffset offset = offset_from_triangles(triangles, point);
        last.tangents = bound_from(offset, point);
        const PackBound plane = plane_before(triangles, last.tangents, lane_of_smallest(offset.squared));
        copy_lane(plane, 0, gatherings_[now_].planes[index / lane_count], index % lane_count);
        last.at = odometer;
        last.faces = lane_bits(offset.is_face);
        looked_at |= PackSet{1} << index;
    }
    return last;
}

// The planes of slivers are known to 1e-12 of the way since they were seen, which is no longer than the
// limit. On their other side the point is as far as a look tells.
bool PackMemory::still_holds(std::size_t index, const TriangleTree& tree, const LanesVec3& point,
                             double limit, double odometer) {
    const Seen& last = seen(index);
    if ((gatherings_[now_].looked_at >> index & 1) == 0 || odometer - last.at > limit) {
        return false;
    }
    const Lanes distances = least_distances(last.tangents, point);
    const unsigned within = lane_bits(distances <= splat(limit));
    if ((within & ~last.faces) != 0 || smallest(distances) <= 0.0) {
        return false;
    }
    TrianglePack room;
    return (within & ~lane_bits(is_above_faces(tree.pack(pack(index), room), point))) == 0;
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
    const PackSet near = near_way(from, whole, length * limit, reach, odometer).packs;
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
