// A half-line from the point along an axis crosses a closed surface outwards once more often than inwards for
// each time that the surface winds around the point.
//
// What would go wrong is a half-line that meets an edge or a corner and is counted for both neighbours or for
// none. So the sides that the half-line passes are decided edge by edge, from the edge's two ends alone and
// in one order, whichever triangle asks: neighbours get the same answer to the last bit. What rounding does
// to it is what bending the edge by as much would do, and a bent surface is closed as well. What is left is
// whether a triangle that the half-line's line passes through lies before or behind the point; where that
// cannot be told the point is on the triangle, or the triangle is seen from its edge: another axis decides
// then.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

// The axes across the half-line, right-handed with it.
struct Across {
    int i, j;
};

Across across(int axis) {
    return {(axis + 1) % 3, (axis + 2) % 3};
}

// A place seen along the half-line.
struct SeenAlong {
    Lanes i, j;
};

SeenAlong seen_along(const LanesVec3& place, const Across& axes) {
    const Lanes* const coordinates[] = {&place.x, &place.y, &place.z};
    return {*coordinates[axes.i], *coordinates[axes.j]};
}

// +1 or -1 where the edge passes the point on its far side along i, upwards or downwards along j; else 0. Its
// lower end counts as on it, its upper end does not: where edges meet, one of them passes.
Lanes passes(const SeenAlong& from, const SeenAlong& to, const SeenAlong& p) {
    const LaneMask from_below = from.j <= p.j;
    const LaneMask to_below = to.j <= p.j;
    const SeenAlong low{select(from_below, from.i, to.i), select(from_below, from.j, to.j)};
    const SeenAlong high{select(from_below, to.i, from.i), select(from_below, to.j, from.j)};
    // > 0: the point is on the left of the way up.
    const Lanes left = (high.i - low.i) * (p.j - low.j) - (p.i - low.i) * (high.j - low.j);
    const LaneMask passing = (from_below ^ to_below) & (left > splat(0.0));
    return select(passing, select(from_below, splat(1.0), splat(-1.0)), splat(0.0));
}

// How each triangle of the pack winds around the half-line's line: -1, 0 or 1.
Lanes turns_around(const TrianglePack& triangles, const LanesVec3& point, const Across& axes) {
    const SeenAlong p = seen_along(point, axes);
    const SeenAlong a = seen_along(triangles.a, axes);
    const SeenAlong b = seen_along(triangles.b, axes);
    const SeenAlong c = seen_along(triangles.c, axes);
    return passes(a, b, p) + passes(b, c, p) + passes(c, a, p);
}

enum class Where { behind, before, unclear };

// Whether the line along `axis` through the point meets the triangle beyond the point. `turn`: how the
// triangle winds around the line.
Where meets(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, int axis, int turn) {
    if (std::min({a[axis], b[axis], c[axis]}) > p[axis]) {
        return Where::before;
    }
    if (std::max({a[axis], b[axis], c[axis]}) < p[axis]) {
        return Where::behind;
    }
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double volume = glm::dot(glm::cross(ab, ac), ap);
    // Each of the six products errs by a few roundings of its factors.
    const double doubt = 0x1p-48 * glm::length(ab) * glm::length(ac) * glm::length(ap);
    if (std::abs(volume) <= doubt) {
        return Where::unclear;
    }
    return (volume < 0.0) == (turn > 0) ? Where::before : Where::behind;
}

}  // namespace

// The boxes are wider than their triangles by rounding, never narrower. One that is unused holds nothing.
bool TriangleTree::crossings(const Vec3& point, int axis, double sign, WorkBudget& work, int& number) const {
    const auto axes = across(axis);
    const LanesVec3 exact = splat(point);
    const Vec3 relative = point - origin_;
    const auto slack = static_cast<float>(float_slack(relative) * (1.0 + 1e-6));
    const auto k = static_cast<std::size_t>(axis);
    const auto i = static_cast<std::size_t>(axes.i), j = static_cast<std::size_t>(axes.j);
    FloatLanes least[3], most[3];
    for (int of = 0; of < 3; ++of) {
        least[of] = splat_float(static_cast<float>(relative[of]) - slack);
        most[of] = splat_float(static_cast<float>(relative[of]) + slack);
    }
    std::uint32_t stack[24 * (node_width - 1) + 1];  // see triangle_tree.cpp
    int depth = 0;
    stack[depth++] = 0;
    bool clear = true;
    number = 0;
    const auto count_in = [&](std::uint32_t index) {
        work.spend(cost::pack_look);
        TrianglePack room;
        const TrianglePack& triangles = pack(index, room);
        const Lanes turns = turns_around(triangles, exact, axes);
        if (!any(turns != splat(0.0))) {
            return;
        }
        const auto ids = triangle_ids(index);
        for (std::size_t lane_of = 0; lane_of < lane_count; ++lane_of) {
            if (lane_of > 0 && ids[lane_of] == ids[lane_of - 1]) {
                break;  // the last triangle fills up the pack
            }
            const int turn = static_cast<int>(turns[lane_of]);
            if (turn == 0) {
                continue;
            }
            const auto [a, b, c] = corners_of(triangles, static_cast<std::uint32_t>(lane_of));
            const Where where = meets(a, b, c, point, axis, turn);
            clear = clear && where != Where::unclear;
            const bool beyond = where == (sign > 0.0 ? Where::before : Where::behind);
            number += beyond ? turn : 0;
        }
    };
    while (depth > 0) {
        const BoxNode& node = nodes_[stack[--depth]];
        if (work.is_gone()) {
            return false;
        }
        const FloatMask holding = (node.low[i] <= most[i]) & (node.high[i] >= least[i]) &
                                  (node.low[j] <= most[j]) & (node.high[j] >= least[j]);
        const FloatMask ahead = sign > 0.0 ? node.high[k] >= least[k] : node.low[k] <= most[k];
        const unsigned slots = lane_bits(holding & ahead);
        work.spend(cost::box_node);
        for (unsigned left = slots; left != 0; left &= left - 1) {
            const std::uint32_t child = node.child[std::countr_zero(left)];
            if (child & BoxNode::leaf_bit) {
                packs_.fetch(child & ~BoxNode::leaf_bit);
            } else {
                fetch_early(&nodes_[child], sizeof(BoxNode));
                stack[depth++] = child;
            }
        }
        for (unsigned left = slots; left != 0; left &= left - 1) {
            const std::uint32_t child = node.child[std::countr_zero(left)];
            if (child & BoxNode::leaf_bit) {
                count_in(child & ~BoxNode::leaf_bit);
            }
        }
    }
    number = sign > 0.0 ? number : -number;
    return clear;
}

// The nearest way out of the tree's box first: it meets the least.
Winding TriangleTree::winding(const Vec3& point, WorkBudget& work) const {
    struct Way {
        double length;
        int axis;
        double sign;
    };
    std::array<Way, 6> ways;
    const Vec3 relative = point - origin_;
    const double rim = extent_ + float_slack(relative);
    if (std::max({std::abs(relative.x), std::abs(relative.y), std::abs(relative.z)}) > rim) {
        return {0, true};
    }
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        double low = rim, high = -rim;
        for (int slot = 0; slot < node_width; ++slot) {
            if (nodes_[0].child[slot] != BoxNode::unused) {
                low = std::min(low, static_cast<double>(nodes_[0].low[axis][slot]));
                high = std::max(high, static_cast<double>(nodes_[0].high[axis][slot]));
            }
        }
        ways[2 * k] = {high - relative[axis], axis, 1.0};
        ways[2 * k + 1] = {relative[axis] - low, axis, -1.0};
    }
    std::ranges::sort(ways, {}, &Way::length);
    Winding winding;
    for (const Way& way : ways) {
        winding.known = crossings(point, way.axis, way.sign, work, winding.number);
        if (winding.known || work.is_gone()) {
            break;
        }
    }
    return winding;
}

}  // namespace tactus
