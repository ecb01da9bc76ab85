// What is known of four triangles after a look at them, wherever the point has gone since.
#pragma once

#include <limits>

#include "core/math/lanes.hpp"

namespace tactus {

// No triangle of lane i is nearer to a point x than normal_i . x + offset_i. Distance to a convex set lies
// above its tangents, so this stays true wherever x goes, and nearly exact while x slides along the surface.
struct PackBound {
    LanesVec3 normal;
    Lanes offset;  // (unit: meters)
};

inline Lanes least_distances(const PackBound& bound, const LanesVec3& point) {
    return dot(bound.normal, point) + bound.offset;
}

// The height of a point over a tangent plane, while the point goes its way.
struct TangentHeight {
    Lanes start;   // (unit: meters)
    Lanes change;  // until the end of the way (unit: meters)
};

// How far two unit normals are apart, 1 - cos of their angle: without the cancellation.
inline Lanes apartness(const LanesVec3& a, const LanesVec3& b) {
    const LanesVec3 difference = a - b;
    return splat(0.5) * dot(difference, difference);
}

// A lower bound of the distances on a way, from tangents: distance lies above both, and the lowest place of
// the larger is at an end or where they cross.
inline Lanes least_over_tangents(const TangentHeight& first, const TangentHeight& last) {
    const Lanes first_end = first.start + first.change;
    const Lanes last_end = last.start + last.change;
    const Lanes apart = first.start - last.start;
    const Lanes crossing = multiply_add(first.change, apart / (apart + (last_end - first_end)), first.start);
    const Lanes lowest = select(first.change >= splat(0.0), first.start,
                                select(last.change <= splat(0.0), last_end, crossing));
    return select(first.start > last.start, lowest, lanes_min(last.start, last_end));
}

// Whether the wedge between both planes, behind which the triangle lies, keeps it farther away than that.
// With the heights a and b over them and k = 1 - cos of the normals' angle, a point that is nearest to the
// wedge's edge is
//
//     q = ((a - b)^2 + 2 k a b) / (k (2 - k))
//
// from it, squared; along the way that is a parabola. Its lowest place counts if the edge is nearest there,
// for distance to something convex has no other lowest place. A triangle whose same edge or corner is nearest
// at both ends of the way is as near as that to the rounding, so what is only passed by is told in one step;
// by tangents alone it takes one for every halving of the way that is left. Heights stand here times `bend`,
// which saves the division.
inline LaneMask wedge_is_farther(const TangentHeight& first, const TangentHeight& last, const Lanes& apart,
                                 const Lanes& distance) {
    // Below, both planes are one; above, they face each other, and heights over them tell little of the edge.
    constexpr double least_apart = 1e-12, largest_apart = 1.9;
    const Lanes a = first.start, da = first.change, b = last.start, db = last.change;
    const Lanes zero = splat(0.0), two = splat(2.0);
    const Lanes turns = da - db;
    const Lanes bend = turns * turns + two * apart * da * db;
    const Lanes lowest = -((a - b) * turns + apart * (a * db + b * da));  // share of the way, times bend
    const Lanes x = a * bend + da * lowest;
    const Lanes y = b * bend + db * lowest;
    const Lanes cosine = splat(1.0) - apart;
    const LaneMask edge_is_nearest = (lowest > zero) & (lowest < bend) & (x >= cosine * y) &
                                     (y >= cosine * x) & (x > zero) & (apart > splat(least_apart)) &
                                     (apart < splat(largest_apart));
    const Lanes limit = distance * bend;
    return edge_is_nearest &
           ((x - y) * (x - y) + two * apart * x * y > limit * limit * apart * (two - apart));
}

// The lanes whose triangle may come within the distance of the point on its way.
inline LaneMask may_come_within(const TangentHeight& first, const TangentHeight& last,
                                const LanesVec3& first_normal, const LanesVec3& last_normal,
                                const Lanes& distance) {
    const LaneMask may = ~(least_over_tangents(first, last) > distance);
    return any(may) ? may & ~wedge_is_farther(first, last, apartness(first_normal, last_normal), distance)
                    : may;
}

// The same between two points, from any tangents and those at the end.
inline bool may_come_within(const PackBound& first, const PackBound& last, const LanesVec3& from,
                            const LanesVec3& to, double distance) {
    const auto height = [&](const PackBound& over) {
        const Lanes start = least_distances(over, from);
        return TangentHeight{start, least_distances(over, to) - start};
    };
    return any(may_come_within(height(first), height(last), first.normal, last.normal, splat(distance)));
}

// The least distances from a point that goes on from there: a plane is nearest at either end of a way.
inline Lanes lowest_on_way(const PackBound& bound, const Lanes& start, const LanesVec3& motion) {
    return start + lanes_min(splat(0.0), dot(bound.normal, motion));
}

// Whether the tangents let the point come within the distance on its way.
inline bool comes_below(const PackBound& bound, const LanesVec3& from, const LanesVec3& motion,
                        double distance) {
    return any(lowest_on_way(bound, least_distances(bound, from), motion) <= splat(distance));
}

// No earlier than this (a share of the way) does a point come within `distance` of a triangle of the pack;
// infinite where it only moves away. `at` may be tangents from anywhere.
inline double earliest_below(const PackBound& at, const LanesVec3& from, const LanesVec3& motion,
                             double distance) {
    const Lanes zero = splat(0.0);
    const Lanes gap = least_distances(at, from) - splat(distance);
    const Lanes rate = dot(at.normal, motion);
    const Lanes never = splat(std::numeric_limits<double>::infinity());
    const Lanes later = select(rate < zero, lanes_max(-gap / rate, zero), never);
    return smallest(select(gap <= zero, zero, later));
}

}  // namespace tactus
