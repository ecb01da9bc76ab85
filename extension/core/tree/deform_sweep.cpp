#include "core/tree/deform_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

double longest(const LanesVec3& v, int i) {
    return glm::length(lane(v, i));
}

// A point that goes evenly, and boxes whose sides do as well.
struct FloatDrive {
    float t;
    FloatPoint at, motion;  // at t, and as t grows by 1
    float room;
};

// When the point enters each box between the two, grown by the room: lower bounds in [t, 1], infinite where
// it does not.
FloatLanes entry_into(const BoxNode& from, const BoxNode& to, const FloatDrive& drive) {
    const FloatLanes share = splat_float(drive.t);
    const FloatLanes room = splat_float(drive.room);
    const FloatLanes zero = splat_float(0.0f);
    const BoxNode now = between(from, to, share);
    FloatLanes enter = share;
    FloatLanes leave = splat_float(1.0f);
    const auto stays_above_zero = [&](FloatLanes gap, FloatLanes rate) {  // gap + rate (s - t) >= 0
        const FloatLanes crossing = share - gap / rate;
        enter = (rate > zero) ? box_detail::most(enter, crossing) : enter;
        leave = (rate < zero) ? box_detail::least(leave, crossing) : leave;
        leave = ((rate == zero) & (gap < zero)) ? splat_float(-1.0f) : leave;
    };
    const FloatLanes* const place[] = {&drive.at.x, &drive.at.y, &drive.at.z};
    const FloatLanes* const motion[] = {&drive.motion.x, &drive.motion.y, &drive.motion.z};
    for (int axis = 0; axis < 3; ++axis) {
        stays_above_zero(*place[axis] - now.low[axis] + room,
                         *motion[axis] - (to.low[axis] - from.low[axis]));
        stays_above_zero(now.high[axis] + room - *place[axis],
                         to.high[axis] - from.high[axis] - *motion[axis]);
    }
    const auto used = from.low[0] <= from.high[0];
    return (used & (enter <= leave)) ? enter : splat_float(__builtin_inff());
}

}  // namespace

Vec3 weights_of(const Vec3& point, const TriangleCorners& t) {
    const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = point - t.a;
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

DeformSweep::MovingPack DeformSweep::pack_at(std::uint32_t index, double t) const {
    TrianglePack room_was, room_is;
    const TrianglePack& was = from_.pack(index, room_was);
    const TrianglePack& is = to_.pack(index, room_is);
    const TrianglePack motion{is.a - was.a, is.b - was.b, is.c - was.c};
    const Lanes share = splat(t);
    return {{along(was.a, motion.a, share), along(was.b, motion.b, share), along(was.c, motion.c, share)},
            motion};
}

Vec3 DeformSweep::motion_of(const Seen& seen, double t, const Vec3& point) const {
    const TriangleCorners was = from_.corners(seen.slot);
    const TriangleCorners is = to_.corners(seen.slot);
    const TriangleCorners motion{is.a - was.a, is.b - was.b, is.c - was.c};
    const Vec3 weights =
        weights_of(point - seen.offset, {was.a + motion.a * t, was.b + motion.b * t, was.c + motion.c * t});
    return motion.a * weights.x + motion.b * weights.y + motion.c * weights.z;
}

// A triangle that is `distance` away comes nearer by no more than its fastest corner does, seen from the
// point; and not before its box lets it.
double DeformSweep::free_until(double t, const Vec3& point, const Vec3& motion, double room,
                               WorkBudget& work) const {
    const Vec3 relative = point - from_.origin_;
    const Vec3 end = relative + motion;
    const double slack = slack_at(relative) + slack_at(end);
    const FloatDrive drive{static_cast<float>(t), to_float_point(relative), to_float_point(motion),
                           static_cast<float>(room + slack)};
    const LanesVec3 exact = splat(point);
    const LanesVec3 way = splat(motion);
    constexpr double blur = 1e-6;  // of times in single precision
    float until = 1.0f;
    const float left_out = from_.visit_best_first(
        until, work,
        [&](std::uint32_t node) {
            work.spend(cost::box_node);
            return entry_into(from_.nodes_[node], to_.nodes_[node], drive);
        },
        [&](std::uint32_t pack, float key) {
            work.spend(2 * cost::pack_look);
            const MovingPack moving = pack_at(pack, t);
            const PackOffset seen = offset_from_triangles(moving.at, exact);
            for (int i = 0; i < lane_count; ++i) {
                const double gap = std::sqrt(seen.squared[i]) - room;
                const double speed =
                    std::max({longest(moving.motion.a - way, i), longest(moving.motion.b - way, i),
                              longest(moving.motion.c - way, i)});
                const double meets = gap <= 0.0 ? t : gap < speed * (until - t) ? t + gap / speed : until;
                until = std::min(until, std::max(static_cast<float>(meets), key));
            }
        });
    const double known = std::min(until, left_out);
    return std::max(t, known >= 1.0 ? 1.0 : known * (1.0 - blur));
}

}  // namespace tactus
