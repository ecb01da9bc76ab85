// Four triangles side by side, and the two questions the proxy asks of them: how far is a point, and when
// does a moving point come within a given distance.
//
// A sphere of radius r moving against a triangle is a point moving against the triangle inflated by r: two
// faces, three cylinders and three spheres (thesis 3.2.3, figure 3.8). "Distance to the triangle equals r"
// describes all eight pieces at once, so one distance kernel answers for them together and no seam between
// pieces can leak.
#pragma once

#include <bit>
#include <limits>

#include "core/geometry/hit.hpp"
#include "core/math/lanes.hpp"

namespace tactus {

// Corners in the frame of the mesh (unit: meters). A pack with fewer than four triangles repeats its last
// one.
struct alignas(32) TrianglePack {
    LanesVec3 a, b, c;
};

struct TriangleCorners {
    Vec3 a, b, c;
};

// Of one triangle, of a pack in either precision.
template <class Pack>
TriangleCorners corners_of(const Pack& pack, std::uint32_t lane) {
    const auto corner = [&](const auto& of) { return Vec3(of.x[lane], of.y[lane], of.z[lane]); };
    return {corner(pack.a), corner(pack.b), corner(pack.c)};
}

struct PackOffset {
    LanesVec3 offset;  // from the closest point of each triangle to the point (unit: meters)
    Lanes squared;     // its squared length (unit: square meters)
};

// The sine of a triangle's sharpest angle, or what comes to the same, below which its normal's direction is
// rounding: such a triangle is its edges (docs/tolerances.md).
constexpr double flat_area = 1e-12;

namespace pack_detail {

// Offset of a point from a segment; `from_start` = point - start. A segment without length is its start.
inline PackOffset offset_from_segment(const LanesVec3& from_start, const LanesVec3& edge) {
    const Lanes squared_length = lanes_max(dot(edge, edge), splat(1e-300));
    const Lanes share = lanes_min(lanes_max(dot(from_start, edge) / squared_length, splat(0.0)), splat(1.0));
    const LanesVec3 offset = along(from_start, edge, -share);
    return {offset, dot(offset, offset)};
}

inline PackOffset nearer(const PackOffset& p, const PackOffset& q) {
    const LaneMask first = p.squared <= q.squared;
    return {select(first, p.offset, q.offset), select(first, p.squared, q.squared)};
}

}  // namespace pack_detail

// The point is measured against the three edges, each well-conditioned by itself, and against the plane where
// it projects inside. The height over the plane is taken from the nearest edge point: it lies in the plane
// too, and so the plane is never called farther than the edges, however badly the normal of a sliver is
// known. Where rounding calls a point inside that is not, the error is on the near, safe side. Below
// `flat_area` (the sine of the sharpest angle) the normal's direction is rounding: such a triangle is its
// edges.
inline PackOffset offset_from_triangles(const TrianglePack& t, const LanesVec3& point) {
    using namespace pack_detail;
    const LanesVec3 ab = t.b - t.a;
    const LanesVec3 ac = t.c - t.a;
    const LanesVec3 ap = point - t.a;
    const LanesVec3 bp = point - t.b;

    PackOffset best = nearer(offset_from_segment(ap, ab), offset_from_segment(ap, ac));
    best = nearer(best, offset_from_segment(bp, t.c - t.b));

    // Twice the signed areas of (p, a, b), (p, c, a), (p, b, c) seen along the normal, each times the
    // normal's length.
    const LanesVec3 normal = cross(ab, ac);
    const Lanes squared_normal = dot(normal, normal);
    const Lanes area_ab = dot(normal, cross(ab, ap));
    const Lanes area_ca = dot(normal, cross(ap, ac));
    const Lanes area_bc = squared_normal - area_ab - area_ca;
    const Lanes zero = splat(0.0);
    const Lanes squared_sides = dot(ab, ab) * dot(ac, ac);
    const LaneMask inside = (area_ab >= zero) & (area_ca >= zero) & (area_bc >= zero) &
                            (squared_normal > squared_sides * splat(flat_area * flat_area));

    const Lanes height = dot(normal, best.offset) / lanes_max(squared_normal, splat(1e-300));
    const LanesVec3 offset = normal * height;
    const PackOffset plane{offset, dot(offset, offset)};
    return {select(inside, plane.offset, best.offset), select(inside, plane.squared, best.squared)};
}

// What is known of a pack after one look: no triangle of lane i is nearer to a point x than normal_i . x +
// offset_i. Distance to a convex set lies above its tangents, so this stays true wherever x goes, and nearly
// exact while x slides along the surface.
struct PackBound {
    LanesVec3 normal;
    Lanes offset;  // (unit: meters)
};

inline PackBound bound_from(const PackOffset& seen, const LanesVec3& from) {
    const Lanes distance = lanes_sqrt(seen.squared);
    const LanesVec3 normal = seen.offset * (splat(1.0) / lanes_max(distance, splat(1e-150)));
    return {normal, distance - dot(normal, from)};
}

inline Lanes least_distances(const PackBound& bound, const LanesVec3& point) {
    return dot(bound.normal, point) + bound.offset;
}

// A lower bound of the distances on the way between two points, from any tangents and those at the end: the
// distance lies above both, and the lowest place of the larger is at an end or where they cross.
inline Lanes least_between(const PackBound& first, const PackBound& last, const LanesVec3& from,
                           const LanesVec3& to) {
    const Lanes first_from = least_distances(first, from);
    const Lanes first_to = least_distances(first, to);
    const Lanes last_from = least_distances(last, from);
    const Lanes last_to = least_distances(last, to);
    const Lanes apart = first_from - last_from;
    const Lanes crossing =
        multiply_add(first_to - first_from, apart / (apart + (last_to - first_to)), first_from);
    const Lanes lowest =
        select(first_to >= first_from, first_from, select(last_to <= last_from, last_to, crossing));
    return select(first_from > last_from, lowest, lanes_min(last_from, last_to));
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

// How far the moving point is from being stopped, and how fast that changes.
struct SweepLook {
    Lanes gap;   // (unit: meters)
    Lanes rate;  // (unit: meters per unit of t)
};

struct PackHit {
    double t = 0.0;
    int lane = -1;  // of the triangle that is hit; -1: none
    int looks = 0;  // at the four distances: what it cost

    bool found() const { return lane >= 0; }
};

// The earliest t in [0, limit] at which the sphere comes within way.distance (+ way.slack) of a triangle of
// the pack. Starting within the distance counts at t = 0 when moving closer, not when moving away.
//
// Distance to a convex set is a convex function of t. Newton's iterates from the far side therefore never
// step past the first root: the answer is conservative at every iteration, and a graze that converges slowly
// ends early, not late.
inline PackHit sweep_to_triangles(const TrianglePack& triangles, const SphereWay& way, double limit) {
    constexpr int max_looks = 30;
    const LanesVec3 direction = splat(way.motion);
    const LanesVec3 origin = splat(way.start);
    const Lanes zero = splat(0.0);
    const Lanes slack = splat(way.slack);
    const auto look = [&](const Lanes& t) {
        const PackOffset at = offset_from_triangles(triangles, along(origin, direction, t));
        const Lanes length = lanes_sqrt(lanes_max(at.squared, splat(1e-300)));
        return SweepLook{length - splat(way.distance), dot(at.offset, direction) / length};
    };
    // Most triangles are only passed by: from both ends of the way, the tangents of a convex function leave
    // no room for a hit between them.
    const SweepLook first = look(zero);
    const SweepLook last = look(splat(limit));
    const Lanes crossing = (first.gap - last.gap + last.rate * splat(limit)) / (last.rate - first.rate);
    const Lanes lowest = select(last.rate > zero, first.gap + first.rate * crossing, last.gap);
    LaneMask open = (first.rate < zero) & ~(lanes_min(lowest, first.gap) > slack);

    const Lanes never = splat(std::numeric_limits<double>::infinity());
    Lanes hit = select(open & (first.gap <= slack), zero, never);
    open &= first.gap > slack;
    Lanes t = select(open, -first.gap / first.rate, zero);
    open &= t <= splat(limit);
    int looks = 2;
    for (; looks < max_looks && any(open); ++looks) {
        const SweepLook at = look(t);
        const LaneMask approaching = at.rate < zero;
        const LaneMask reached = open & approaching & (at.gap <= slack);
        hit = select(reached, t, hit);
        open &= approaching & ~reached;
        t = select(open, t - at.gap / at.rate, t);
        open &= t <= splat(limit);
    }
    hit = select(open, t, hit);
    const double earliest = smallest(hit);
    if (!(earliest <= limit)) {
        return {0.0, -1, looks};
    }
    return {earliest, std::countr_zero(lane_bits(hit == splat(earliest))), looks};
}

}  // namespace tactus
