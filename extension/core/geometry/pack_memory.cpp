#include "core/geometry/pack_memory.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace tactus {

namespace {

// Packs that lie side by side have numbers side by side (Fibonacci hashing).
std::size_t place_of(std::uint32_t pack) {
    return (pack * 2'654'435'769u) >> 24;
}

}  // namespace

void PackMemory::set_plane(std::size_t index, const PackPlane& plane) {
    Block& block = blocks_[index / lane_count];
    const std::size_t lane = index % lane_count;
    block.normal.x[lane] = plane.normal.x;
    block.normal.y[lane] = plane.normal.y;
    block.normal.z[lane] = plane.normal.z;
    block.offset[lane] = plane.offset;
}

PackBound PackMemory::look_at(std::size_t index, const TriangleTree& tree, const LanesVec3& point,
                              double odometer) {
    Remembered& remembered = packs_[index];
    if (remembered.known >= 0 && remembered.looked_at == odometer) {
        return tangents_of(remembered);
    }
    const TrianglePack& triangles = tree.pack(remembered.pack);
    const PackBound tangents = bound_from(offset_from_triangles(triangles, point), point);
    const Lanes exact = least_distances(tangents, point);
    const PackPlane plane = plane_before(triangles, tangents, exact);
    if (remembered.known < 0 && known_count_ < known_capacity) {
        remembered.known = static_cast<std::int32_t>(known_count_++);
    }
    if (remembered.known >= 0) {
        (*known_)[static_cast<std::size_t>(remembered.known)] = {tangents, plane};
        remembered.looked_at = odometer;
    }
    set_plane(index, plane);
    set_clear(index, odometer + smallest(exact));
    return tangents;
}

// The end is looked at first: what is learnt there is asked again as soon as the proxy has arrived. Of old
// tangents and those at the end, the start is seldom needed, too.
bool PackMemory::may_meet(std::size_t index, const TriangleTree& tree, const LanesVec3& from,
                          const LanesVec3& to, double length, double limit, double odometer) {
    const Remembered& remembered = packs_[index];
    const Lanes near = splat(limit);
    if (remembered.known < 0) {
        look_at(index, tree, from, odometer);
        return remembered.known < 0 || may_meet(index, tree, from, to, length, limit, odometer);
    }
    const PackBound old = tangents_of(remembered);
    const bool is_from_start = remembered.looked_at == odometer;
    if (!any(lanes_min(least_distances(old, from), least_distances(old, to)) <= near)) {
        return false;
    }
    const PackBound last = look_at(index, tree, to, odometer + length);
    set_clear(index, odometer + smallest(least_distances(last, to)) - length);
    const bool meets = any(least_between(old, last, from, to) <= near);
    if (is_from_start || !meets) {
        return meets;
    }
    const PackBound first = bound_from(offset_from_triangles(tree.pack(remembered.pack), from), from);
    return any(least_between(first, last, from, to) <= near);
}

void PackMemory::remember_known() {
    std::memset(table_.data(), 0xff, sizeof(table_));  // no pack, known -1
    for (std::size_t i = 0; i < count_; ++i) {
        if (packs_[i].known < 0) {
            continue;
        }
        std::size_t place = place_of(packs_[i].pack);
        while (table_[place].known >= 0) {
            place = (place + 1) % table_size;
        }
        table_[place] = {packs_[i].pack, packs_[i].known};
    }
    std::swap(known_, old_known_);
}

std::int32_t PackMemory::remembered(std::uint32_t pack) const {
    std::size_t place = place_of(pack);
    while (table_[place].known >= 0 && table_[place].pack != pack) {
        place = (place + 1) % table_size;
    }
    return table_[place].known;
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

bool PackMemory::gather(const TriangleTree& tree, const Vec3& center, double radius, const Vec3& point,
                        double soon, double odometer, WorkBudget& work) {
    std::array<FoundPack, capacity> found;
    const FoundPacks packs = tree.packs_within(center, radius, point, found);
    work.spend(static_cast<std::int64_t>(packs.count) + cost::box_node);
    if (!packs.complete) {
        clear();
        return false;
    }
    remember_known();
    count_ = packs.count;
    known_count_ = 0;
    center_ = center;
    radius_ = radius;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count_; ++i) {
        const double distance = static_cast<double>(found[i].distance);
        const std::uint32_t pack = found[i].pack;
        std::int32_t known = remembered(pack);
        PackPlane plane{Vec3(0.0), -infinity};
        if (known >= 0) {
            const Known& old = (*old_known_)[static_cast<std::size_t>(known)];
            plane = old.plane;
            known = static_cast<std::int32_t>(known_count_++);
            (*known_)[static_cast<std::size_t>(known)] = old;
        } else if (distance <= soon) {
            tree.fetch_pack(pack);
        }
        packs_[i] = {pack, known, -1.0};
        set_plane(i, plane);
        set_clear(i, odometer + distance);
    }
    for (std::size_t i = count_; i % lane_count != 0; ++i) {
        set_plane(i, {Vec3(0.0), -infinity});
        set_clear(i, infinity);
    }
    return true;
}

// Of two ways to the same end, the tangents at the start tell when a pack can be met at the earliest: the
// earliest are swept first, and end the search for most of the others.
Hit PackMemory::sweep(const TriangleTree& tree, const SphereWay& way, double limit, double odometer,
                      WorkBudget& work) {
    const double reach = way.distance + way.slack;
    const double length = glm::length(way.motion);
    const LanesVec3 from = splat(way.start);
    const LanesVec3 direction = splat(way.motion);
    std::array<Candidate, capacity> candidates;
    std::size_t count = 0;
    visit_between(from, splat(way.start + way.motion * limit), length * limit, reach, odometer,
                  [&](std::size_t i) {
                      const PackBound at =
                          packs_[i].known >= 0 ? tangents_of(packs_[i]) : look_at(i, tree, from, odometer);
                      const double t = earliest_below(at, from, direction, reach);
                      if (t <= limit) {
                          candidates[count++] = {t, static_cast<std::uint32_t>(i)};
                      }
                  });
    work.spend(static_cast<std::int64_t>(count_ / lane_count + count * cost::pack_look));
    Hit hit;
    hit.t = limit;
    const auto later = [](const Candidate& p, const Candidate& q) { return p.t > q.t; };
    const auto first = candidates.begin();
    std::make_heap(first, first + static_cast<std::ptrdiff_t>(count), later);
    for (; count > 0 && candidates[0].t <= hit.t; --count) {
        const Candidate next = candidates[0];
        if (work.is_gone()) {
            return {next.t, false, false, Hit::no_triangle};
        }
        std::pop_heap(first, first + static_cast<std::ptrdiff_t>(count), later);
        const LanesVec3 to = splat(way.start + way.motion * hit.t);
        work.spend(2 * cost::pack_look);
        if (!may_meet(next.index, tree, from, to, length * hit.t, reach, odometer)) {
            continue;
        }
        const std::uint32_t pack = packs_[next.index].pack;
        const PackHit met = sweep_to_triangles(tree.pack(pack), way, hit.t);
        work.spend(met.looks * cost::pack_look);
        if (met.found()) {
            hit.t = met.t;
            hit.found = true;
            hit.triangle = pack * lane_count + static_cast<std::uint32_t>(met.lane);
        }
    }
    return hit;
}

}  // namespace tactus
