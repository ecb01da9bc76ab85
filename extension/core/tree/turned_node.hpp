// Beside each node of the triangle tree: for every child, a box turned the way its surface lies. A box along
// the axes around a piece of surface that stands askew protrudes from it by half the piece's width, and that
// around a sliver covers thousands of its neighbours; seen from a sphere, both hide how far aside of the
// touching place the piece is.
//
// Everything is measured from the middle of the child's box, so that rounding is small where the child is
// small.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/tree/box_node.hpp"

namespace tactus {

using ShortLanes = std::int16_t __attribute__((vector_size(16)));
using ShareLanes = std::uint16_t __attribute__((vector_size(16)));

struct alignas(32) TurnedNode {
    // A unit vector across the surface, no longer than 1; 0 where no plane fits it.
    FloatPoint normal;
    FloatLanes low, high;  // normal . x of its triangles (unit: meters)
    // The way in the surface that it extends farthest, about of length 2^15; with the normal it gives the
    // axes.
    ShortLanes along[3];
    // The largest |along . x| and |third . x|, in units of `share_unit`.
    ShareLanes length, width;
};

// The axes of turned boxes beside the normal: across it and each other to a float's rounding, no longer than
// 1 and less by what the short numbers leave out.
struct TurnedAxes {
    FloatPoint along, third;
};

// What a length along such an axis is more than told, squared: its numbers err by 2^-16 of it each.
constexpr float short_axes = 1.0003f;

// Stored lengths are larger by this share of the box's size, for what float products lose there.
constexpr double turned_margin = 2e-6;

inline FloatPoint middle_of(const BoxNode& boxes) {
    const FloatLanes half = splat_float(0.5f);
    return {(boxes.low[0] + boxes.high[0]) * half, (boxes.low[1] + boxes.high[1]) * half,
            (boxes.low[2] + boxes.high[2]) * half};
}

inline TurnedAxes axes_of(const TurnedNode& turned) {
    const FloatLanes unit = splat_float(0x1p-15f);
    const auto widened = [&](const ShortLanes& v) { return __builtin_convertvector(v, FloatLanes) * unit; };
    const FloatPoint about{widened(turned.along[0]), widened(turned.along[1]), widened(turned.along[2])};
    const FloatPoint third = cross(turned.normal, about);
    return {cross(third, turned.normal), third};
}

// Lengths of a turned box are shares of the three sides together of its child's box along the axes: none is
// longer, wherever between them rounding has put the middle. They err by a few hundred-thousandths: were it a
// hundredth, the walls of a bore would all seem to reach into a sphere that sits on their rim.
inline FloatLanes share_unit(const BoxNode& boxes) {
    constexpr float share = 1.0001f / 65'535.0f;
    return ((boxes.high[0] - boxes.low[0]) + (boxes.high[1] - boxes.low[1]) +
            (boxes.high[2] - boxes.low[2])) *
           splat_float(share);
}
// The smallest share not below a length, and back.
inline std::uint16_t share_up(double length, float unit) {
    return static_cast<std::uint16_t>(std::min(65'535.0, std::ceil(length * (1.0 + 1e-6) / unit)));
}
inline FloatLanes lengths_of(const ShareLanes& shares, FloatLanes unit) {
    return __builtin_convertvector(shares, FloatLanes) * unit;
}

namespace box_detail {
inline FloatLanes size_of(FloatLanes a) {
    return most(a, -a);
}

// How far a point is beyond the sides of each turned box along its three axes, and less by what rounding may
// hide; 0 between them, below 0 on the lower side.
struct Beyond {
    FloatLanes normal, along, third;
};

// `rounding`: of the point. The vectors err by 2^-24, differences, three products and two sums lose as much
// of a length each.
inline Beyond beyond_turned(const BoxNode& boxes, const TurnedNode& turned, const TurnedAxes& axes,
                            const FloatPoint& p, float rounding) {
    const FloatPoint offset = p - middle_of(boxes);
    const FloatLanes zero = splat_float(0.0f);
    const FloatLanes n = dot(turned.normal, offset);
    const FloatLanes a = dot(axes.along, offset);
    const FloatLanes t = dot(axes.third, offset);
    const FloatLanes doubt =
        splat_float(rounding) + splat_float(4e-7f) * (size_of(n) + size_of(a) + size_of(t));
    const FloatLanes upper = most(n - turned.high - doubt, zero);
    const FloatLanes lower = most(turned.low - n - doubt, zero);
    const FloatLanes unit = share_unit(boxes);
    const FloatLanes far = most(size_of(a) - lengths_of(turned.length, unit) - doubt - doubt, zero);
    const FloatLanes aside = most(size_of(t) - lengths_of(turned.width, unit) - doubt - doubt, zero);
    return {upper - lower, (a > zero) ? far : -far, (t > zero) ? aside : -aside};
}

inline FloatLanes squared_length(const Beyond& v) {
    return v.normal * v.normal + v.along * v.along + v.third * v.third;
}

// The same as `nearing` for boxes; whichever is farther away.
inline Nearing nearing(const BoxNode& boxes, const TurnedNode& turned, const TurnedAxes& axes,
                       const FloatWay& way, const FloatPoint& center) {
    const Beyond from = beyond_turned(boxes, turned, axes, center, way.rounding);
    const FloatLanes distance = float_sqrt(squared_length(from));
    const FloatLanes away = from.normal * dot(turned.normal, way.motion) +
                            from.along * dot(axes.along, way.motion) +
                            from.third * dot(axes.third, way.motion);
    const Nearing box = nearing(boxes, way, center);
    const FloatLanes gap = distance * splat_float(1.0f - 1e-6f) - splat_float(way.distance);
    const auto farther = gap > box.gap;
    return {farther ? gap : box.gap, farther ? away / -distance : box.rate};
}

// Where nothing of a turned box lies ahead of the sphere's centre: all of it is left behind from the start.
inline FloatMask is_behind(const BoxNode& boxes, const TurnedNode& turned, const TurnedAxes& axes,
                           const FloatWay& way) {
    const FloatLanes rise = dot(turned.normal, way.motion);
    const FloatLanes unit = share_unit(boxes);
    const FloatLanes length = lengths_of(turned.length, unit);
    const FloatLanes width = lengths_of(turned.width, unit);
    const FloatLanes reach = most(turned.low * rise, turned.high * rise) +
                             length * splat_float(short_axes) * size_of(dot(axes.along, way.motion)) +
                             width * splat_float(short_axes) * size_of(dot(axes.third, way.motion));
    const FloatLanes size = length + width + (turned.high - turned.low) + splat_float(way.distance);
    const auto has_axes = length > splat_float(0.0f);
    return has_axes &
           (dot(middle_of(boxes) - way.start, way.motion) + reach < splat_float(-2.0f * way.blur) * size);
}
}  // namespace box_detail

// As squared_distance_to_boxes; `rounding` is that of the point (unit: meters).
inline FloatLanes squared_distance(const BoxNode& boxes, const TurnedNode& turned, const FloatPoint& p,
                                   float rounding) {
    return box_detail::most(
        box_detail::squared_length(box_detail::beyond_turned(boxes, turned, axes_of(turned), p, rounding)),
        squared_distance_to_boxes(boxes, p));
}

// The same, and of each box the plane that it lies behind, as seen from the point: `normal` is a vector to
// the point no longer than 1 but for rounding, 0 where the point is inside.
struct BoxPlanes {
    FloatPoint normal;
    FloatLanes distance;  // of the point (unit: meters)
    FloatLanes squared_distance;
};

// A turned box is what lies between its planes: over it the sum of beyond * axis is largest at the sides that
// the point is beyond of, and there it is by the squared length of beyond less than at the point. The sum's
// axis is no longer than beyond.
inline BoxPlanes planes_before(const BoxNode& boxes, const TurnedNode& turned, const FloatPoint& p,
                               float rounding) {
    using namespace box_detail;
    const TurnedAxes axes = axes_of(turned);
    const Beyond beyond = beyond_turned(boxes, turned, axes, p, rounding);
    const FloatPoint straight = beyond_straight(boxes, p);
    const FloatLanes squared_straight = dot(straight, straight);
    const FloatLanes squared_turned = squared_length(beyond);
    const auto is_turned = squared_turned > squared_straight;
    const FloatLanes squared = is_turned ? squared_turned : squared_straight;
    const FloatLanes distance = float_sqrt(squared);
    const FloatLanes scale = splat_float(1.0f) / most(distance, splat_float(1e-15f));
    const auto along = [&](const FloatLanes& normal, const FloatLanes& first, const FloatLanes& third,
                           const FloatLanes& other) {
        const FloatLanes sum = beyond.normal * normal + beyond.along * first + beyond.third * third;
        return (is_turned ? sum : other) * scale;
    };
    return {{along(turned.normal.x, axes.along.x, axes.third.x, straight.x),
             along(turned.normal.y, axes.along.y, axes.third.y, straight.y),
             along(turned.normal.z, axes.along.z, axes.third.z, straight.z)},
            distance,
            squared};
}

// Lower bounds of the t up to the limit at which the sphere meets what is in each box; infinite for boxes
// that it passes by or leaves behind, and for unused slots. They are convex, so their distance as a function
// of t lies above its tangents at both ends of the way: the first falls to the sphere's radius no earlier
// than t = gap / rate, and where the two cross above it (or the second still falls at the end), no t is left.
//
// Between the ends the distance lies above the tangents' crossing c, too. The box is behind both planes, so
// also behind the one between them that lies along the way: of slopes -m and n (sines of the angles by which
// the normals lean) it is the mean of both with weights n and m, and leans by nothing. Both normals reach it
// with their cosines alone, so it is as far away as
//
//     c (m + n) / (m cos n + n cos m)  >=  c (1 + (m n^2 / 2 + n m^2 / 2) / (m + n)),
//
// which is nearly exact for what is passed by.
// Of thousands that touch at the start, those that the sphere goes at fastest are below 0 by as much: what
// stops it there is found first.
inline FloatLanes earliest_meeting(const BoxNode& boxes, const TurnedNode& turned, const FloatWay& way) {
    using namespace box_detail;
    const FloatLanes zero = splat_float(0.0f);
    const FloatLanes never = splat_float(__builtin_inff());
    const TurnedAxes axes = axes_of(turned);
    const Nearing first = nearing(boxes, turned, axes, way, way.start);
    const Nearing last = nearing(boxes, turned, axes, way, way.end);
    const FloatLanes fall = first.rate + splat_float(way.blur);
    const FloatLanes rise = splat_float(way.blur) - last.rate;  // going back from the end: also a fall
    const FloatLanes limit = splat_float(way.limit);
    const FloatLanes crossing = (first.gap - last.gap + rise * limit) / (fall + rise);
    const auto squared_sine = [&](FloatLanes rate) {
        const FloatLanes sine = most(rate - splat_float(way.blur), zero) * splat_float(way.per_length);
        return sine * sine;
    };
    const FloatLanes tangents = first.gap - fall * crossing;
    const FloatLanes bulge = splat_float(0.49999f) *
                             (fall * squared_sine(-last.rate) + rise * squared_sine(first.rate)) /
                             (fall + rise) * (tangents + splat_float(way.distance));
    const FloatLanes lowest = (rise > zero) ? tangents + bulge : last.gap;
    // What the subtractions may lose: far less than 1e-6 of their operands.
    const FloatLanes doubt = (first.gap + last.gap + rise * limit) * splat_float(1e-6f);
    const auto apart =
        (first.gap > zero) & ((fall <= zero) | ((last.gap > zero) & (lowest > most(doubt, zero))));
    const auto used = boxes.low[0] <= boxes.high[0];
    const FloatLanes key = (first.gap > zero) ? first.gap / fall : -most(first.rate, zero);
    const auto met = used & ~apart & ~is_behind(boxes, turned, axes, way);
    return (met & (key <= splat_float(way.limit * (1.0f + 4e-6f)))) ? key : never;
}

}  // namespace tactus
