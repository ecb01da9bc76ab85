#include "core/geometry/deform_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

constexpr int stack_size = 24 * (node_width - 1) + 1;  // see triangle_tree.cpp

struct Pending {
    std::uint32_t node;
    double key;
};

// Those of a node's children whose key is below the bound, the least on top of the stack.
template <class Key>
void push_children(const BoxNode& node, double bound, Pending* stack, int& depth, Key&& key) {
    const int bottom = depth;
    for (int slot = 0; slot < node_width; ++slot) {
        if (node.child[slot] == BoxNode::unused) {
            continue;
        }
        const double at = key(slot);
        if (!(at < bound)) {
            continue;
        }
        int place = depth++;
        while (place > bottom && stack[place - 1].key < at) {
            stack[place] = stack[place - 1];
            --place;
        }
        stack[place] = {node.child[slot], at};
    }
}

struct Box {
    Vec3 low, high;
};

Box box_of(const BoxNode& node, int slot) {
    return {{node.low[0][slot], node.low[1][slot], node.low[2][slot]},
            {node.high[0][slot], node.high[1][slot], node.high[2][slot]}};
}

double distance_to(const Box& from, const Box& to, double t, const Vec3& p) {
    const Vec3 low = from.low * (1.0 - t) + to.low * t;
    const Vec3 high = from.high * (1.0 - t) + to.high * t;
    return glm::length(p - glm::clamp(p, low, high));
}

// When the point enters the box between the two, grown by `room`: a lower bound in [t, 1], or 2 where it does
// not. Along each axis the point and both sides move evenly.
double entry_into(const Box& from, const Box& to, double t, const Vec3& p, const Vec3& motion, double room) {
    double enter = t, leave = 1.0;
    const auto stays_above_zero = [&](double now, double rate) {  // now + rate (s - t) >= 0
        if (rate > 0.0) {
            enter = std::max(enter, t - now / rate);
        } else if (rate < 0.0) {
            leave = std::min(leave, t - now / rate);
        } else if (now < 0.0) {
            leave = -1.0;
        }
    };
    for (int axis = 0; axis < 3; ++axis) {
        const double low = from.low[axis] * (1.0 - t) + to.low[axis] * t - room;
        const double high = from.high[axis] * (1.0 - t) + to.high[axis] * t + room;
        stays_above_zero(p[axis] - low, motion[axis] - (to.low[axis] - from.low[axis]));
        stays_above_zero(high - p[axis], to.high[axis] - from.high[axis] - motion[axis]);
    }
    return enter <= leave + 1e-12 ? enter * (1.0 - 1e-12) : 2.0;
}

TrianglePack between(const TrianglePack& from, const TrianglePack& to, double t) {
    const Lanes share = splat(t);
    return {along(from.a, to.a - from.a, share), along(from.b, to.b - from.b, share),
            along(from.c, to.c - from.c, share)};
}

// How much each corner counts in a point of the triangle.
Vec3 weights_of(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = point - a;
    const double bb = glm::dot(ab, ab), bc = glm::dot(ab, ac), cc = glm::dot(ac, ac);
    const double area = bb * cc - bc * bc;
    if (!(area > 1e-18 * bb * cc)) {
        return {1.0, 0.0, 0.0};
    }
    const double pb = glm::dot(ap, ab), pc = glm::dot(ap, ac);
    const double v = std::clamp((cc * pb - bc * pc) / area, 0.0, 1.0);
    const double w = std::clamp((bb * pc - bc * pb) / area, 0.0, 1.0 - v);
    return {1.0 - v - w, v, w};
}

double longest(const LanesVec3& v, int i) {
    return glm::length(lane(v, i));
}

}  // namespace

DeformSweep::Nearest DeformSweep::nearest(double t, const Vec3& point, double far, WorkBudget& work) const {
    Nearest nearest{far};
    const Vec3 relative = point - from_.origin_;
    const LanesVec3 exact = splat(point);
    Pending stack[stack_size];
    int depth = 0;
    stack[depth++] = {0, 0.0};
    while (depth > 0 && !work.is_gone()) {
        const Pending item = stack[--depth];
        if (!(item.key < nearest.distance)) {
            continue;
        }
        work.spend(item.node & BoxNode::leaf_bit ? cost::pack_look : 2 * cost::box_node);
        if (!(item.node & BoxNode::leaf_bit)) {
            push_children(from_.nodes_[item.node], nearest.distance, stack, depth, [&](int slot) {
                return distance_to(box_of(from_.nodes_[item.node], slot), box_of(to_.nodes_[item.node], slot),
                                   t, relative) *
                       (1.0 - 1e-12);
            });
            continue;
        }
        const std::uint32_t index = item.node & ~BoxNode::leaf_bit;
        const TrianglePack& was = from_.pack(index);
        const TrianglePack& is = to_.pack(index);
        const TrianglePack now = between(was, is, t);
        const PackOffset seen = offset_from_triangles(now, exact);
        for (int i = 0; i < lane_count; ++i) {
            const double distance = std::sqrt(seen.squared[i]);
            if (distance < nearest.distance) {
                const Vec3 offset = lane(seen.offset, i);
                const Vec3 weights =
                    weights_of(point - offset, lane(now.a, i), lane(now.b, i), lane(now.c, i));
                nearest = {distance, offset,
                           weights.x * lane(is.a - was.a, i) + weights.y * lane(is.b - was.b, i) +
                               weights.z * lane(is.c - was.c, i)};
            }
        }
    }
    return nearest;
}

// A triangle that is `distance` away comes nearer by no more than its fastest corner does, seen from the
// point; and not before its box lets it.
double DeformSweep::free_until(double t, const Vec3& point, const Vec3& motion, double room,
                               WorkBudget& work) const {
    double until = 1.0;
    const Vec3 relative = point - from_.origin_;
    const LanesVec3 exact = splat(point);
    const LanesVec3 way = splat(motion);
    Pending stack[stack_size];
    int depth = 0;
    stack[depth++] = {0, t};
    while (depth > 0) {
        const Pending item = stack[--depth];
        if (!(item.key < until)) {
            continue;
        }
        if (work.is_gone()) {
            return t;
        }
        work.spend(item.node & BoxNode::leaf_bit ? cost::pack_look : 2 * cost::box_node);
        if (!(item.node & BoxNode::leaf_bit)) {
            push_children(from_.nodes_[item.node], until, stack, depth, [&](int slot) {
                return entry_into(box_of(from_.nodes_[item.node], slot), box_of(to_.nodes_[item.node], slot),
                                  t, relative, motion, room);
            });
            continue;
        }
        const std::uint32_t index = item.node & ~BoxNode::leaf_bit;
        const TrianglePack& was = from_.pack(index);
        const TrianglePack& is = to_.pack(index);
        const PackOffset seen = offset_from_triangles(between(was, is, t), exact);
        for (int i = 0; i < lane_count; ++i) {
            const double gap = std::sqrt(seen.squared[i]) - room;
            const double speed = std::max({longest(is.a - was.a - way, i), longest(is.b - was.b - way, i),
                                           longest(is.c - was.c - way, i)});
            const double meets = gap <= 0.0 ? t : gap < speed * (until - t) ? t + gap / speed : until;
            until = std::min(until, std::max(meets, item.key));
        }
    }
    return until;
}

}  // namespace tactus
