// Four triangles side by side, and the two questions the proxy asks of them: how far is a point, and when
// does a moving point come within a given distance.
//
// A sphere of radius r moving against a triangle is a point moving against the triangle inflated by r: two
// faces, three cylinders and three spheres (thesis 3.2.3, figure 3.8). "Distance to the triangle equals r"
// describes all eight pieces at once, so one distance kernel answers for them together and no seam between
// pieces can leak.
#pragma once

#include <limits>

#include "core/math/lanes.hpp"
#include "core/tree/hit.hpp"
#include "core/tree/pack_bound.hpp"

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
    LanesVec3 offset;    // from the closest point of each triangle to the point (unit: meters)
    Lanes squared;       // its squared length (unit: square meters)
    LaneMask is_face{};  // the closest point is inside a triangle that is no sliver
};

// The sine of a triangle's sharpest angle, or what comes to the same, below which its normal's direction is
// rounding: such a triangle is its edges (docs/tolerances.md).
constexpr double flat_area = 1e-12;
// Below that one the normal of a triangle tells less than the offset from its edges.
constexpr double sliver_area = 1e-4;

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

// Twice the signed areas of (p, a, b), (p, c, a), (p, b, c) seen along the normal, each times the normal's
// length, all have its sign.
inline LaneMask projects_inside(const LanesVec3& ab, const LanesVec3& ac, const LanesVec3& ap,
                                const LanesVec3& normal, const Lanes& squared_normal) {
    const Lanes zero = splat(0.0);
    const Lanes area_ab = dot(normal, cross(ab, ap));
    const Lanes area_ca = dot(normal, cross(ap, ac));
    return (area_ab >= zero) & (area_ca >= zero) & (squared_normal - area_ab - area_ca >= zero);
}

}  // namespace pack_detail

// The point is measured against the three edges, each well-conditioned by itself, and against the plane where
// it projects inside. The height over the plane is taken from the nearest edge point: it lies in the plane
// too, and so the plane is never called farther than the edges, however badly the normal of a sliver is
// known. Where rounding calls a point inside that is not, the error is on the near, safe side. Below
// `flat_area` (the sine of the sharpest angle) the normal's direction is rounding: such a triangle is its
// edges. Searches do little else: a call would hand over eighteen vectors by memory.
[[gnu::always_inline]] inline PackOffset offset_from_triangles(const TrianglePack& t,
                                                               const LanesVec3& point) {
    using namespace pack_detail;
    const LanesVec3 ab = t.b - t.a;
    const LanesVec3 ac = t.c - t.a;
    const LanesVec3 ap = point - t.a;
    const LanesVec3 bp = point - t.b;

    PackOffset best = nearer(offset_from_segment(ap, ab), offset_from_segment(ap, ac));
    best = nearer(best, offset_from_segment(bp, t.c - t.b));

    const LanesVec3 normal = cross(ab, ac);
    const Lanes squared_normal = dot(normal, normal);
    const Lanes squared_sides = dot(ab, ab) * dot(ac, ac);
    const LaneMask inside = projects_inside(ab, ac, ap, normal, squared_normal) &
                            (squared_normal > squared_sides * splat(flat_area * flat_area));

    const Lanes height = dot(normal, best.offset) / lanes_max(squared_normal, splat(1e-300));
    const LanesVec3 offset = normal * height;
    return {select(inside, offset, best.offset), select(inside, dot(offset, offset), best.squared),
            inside & (squared_normal > squared_sides * splat(sliver_area * sliver_area))};
}

// The lanes whose closest point is inside the triangle, where that is no sliver.
inline LaneMask is_above_faces(const TrianglePack& t, const LanesVec3& point) {
    const LanesVec3 ab = t.b - t.a;
    const LanesVec3 ac = t.c - t.a;
    const LanesVec3 normal = cross(ab, ac);
    return pack_detail::projects_inside(ab, ac, point - t.a, normal, dot(normal, normal));
}

inline PackBound bound_from(const PackOffset& seen, const LanesVec3& from) {
    const Lanes distance = lanes_sqrt(seen.squared);
    const LanesVec3 normal = seen.offset * (splat(1.0) / lanes_max(distance, splat(1e-150)));
    return {normal, distance - dot(normal, from)};
}

// Whether a way stays farther from the planes of the triangles than that, on one side. Where the plane of a
// sliver is turned by rounding, what lies highest of it counts.
inline LaneMask planes_are_farther(const TrianglePack& t, const LanesVec3& from, const LanesVec3& to,
                                   const Lanes& distance) {
    const Lanes zero = splat(0.0);
    const LanesVec3 ab = t.b - t.a;
    const LanesVec3 ac = t.c - t.a;
    const LanesVec3 up = cross(ab, ac);
    const Lanes start = dot(up, from - t.a);
    const Lanes finish = dot(up, to - t.a);
    const Lanes b = dot(up, ab);
    const Lanes c = dot(up, ac);
    const Lanes above = lanes_min(start, finish) - lanes_max(lanes_max(b, c), zero);
    const Lanes below = lanes_min(lanes_min(b, c), zero) - lanes_max(start, finish);
    const Lanes height = lanes_max(above, below);
    return (height > zero) & (height * height > distance * distance * dot(up, up));
}

// How far the triangles are from the moving point, in which direction, and how fast that changes.
struct SweepLook {
    Lanes distance;    // (unit: meters)
    Lanes rate;        // (unit: meters per unit of t)
    LanesVec3 normal;  // unit, from the triangle
};

namespace pack_detail {

inline SweepLook look_of(const PackBound& known, const LanesVec3& point, const LanesVec3& direction) {
    return {least_distances(known, point), dot(known.normal, direction), known.normal};
}

// The tangents of a look at the start of a way, and of one at its end, from the start on.
inline TangentHeight ahead_of(const SweepLook& start, const Lanes& duration) {
    return {start.distance, start.rate * duration};
}
inline TangentHeight behind(const SweepLook& end, const Lanes& duration) {
    const Lanes change = end.rate * duration;
    return {end.distance - change, change};
}

}  // namespace pack_detail

struct PackHit {
    double t = 0.0;
    int lane = -1;  // of the triangle that is hit; -1: none
    int looks = 0;  // at the four distances: what it cost

    bool found() const { return lane >= 0; }
};

// The earliest t in [0, limit] at which the sphere comes within way.distance (+ way.slack) of a triangle of
// the pack. Starting within the distance counts at t = 0 when moving closer, not when moving away. Tangents
// at the end, where somebody has them, save a look.
//
// Distance to a convex set is a convex function of t. Newton's iterates from the far side therefore never
// step past the first root: the answer is conservative at every iteration, and a graze that converges slowly
// ends early, not late. Most triangles are only passed by: then what is known from an iterate and from the
// end leaves no room for a hit between them.
inline PackHit sweep_to_triangles(const TrianglePack& triangles, const SphereWay& way, double limit,
                                  const PackBound* at_end = nullptr) {
    using namespace pack_detail;
    constexpr int max_looks = 30;
    const LanesVec3 direction = splat(way.motion);
    const LanesVec3 origin = splat(way.start);
    const Lanes end = splat(limit);
    const Lanes slack = splat(way.slack);
    const Lanes reach = splat(way.distance + way.slack);
    const auto look = [&](const Lanes& t) {
        const PackOffset at = offset_from_triangles(triangles, along(origin, direction, t));
        const Lanes length = lanes_sqrt(lanes_max(at.squared, splat(1e-300)));
        return SweepLook{length, dot(at.offset, direction) / length, at.offset * (splat(1.0) / length)};
    };
    Lanes hit = splat(std::numeric_limits<double>::infinity());
    Lanes t = splat(0.0);
    LaneMask open = end >= t;
    SweepLook last{};
    int looks = 0;
    while (any(open) && looks < max_looks) {
        const SweepLook at = look(t);
        const Lanes gap = at.distance - splat(way.distance);
        open &= at.rate < splat(0.0);
        const LaneMask reached = open & (gap <= slack);
        hit = select(reached, t, hit);
        const Lanes next = t - gap / at.rate;
        open &= ~reached & (next <= end);
        ++looks;
        if (!any(open)) {
            break;
        }
        if (looks == 1) {
            const LanesVec3 place = along(origin, direction, end);
            last = at_end != nullptr ? look_of(*at_end, place, direction) : look(end);
            looks += at_end == nullptr;
            open &= ~planes_are_farther(triangles, origin, place, reach);
        }
        open &= may_come_within(ahead_of(at, end - t), behind(last, end - t), at.normal, last.normal, reach);
        t = select(open, next, t);
    }
    hit = select(open, t, hit);
    const double earliest = smallest(hit);
    if (!(earliest <= limit)) {
        return {0.0, -1, looks};
    }
    return {earliest, lane_of_smallest(hit), looks};
}

}  // namespace tactus
