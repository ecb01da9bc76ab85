// A mesh between two forms of the same triangles: every corner goes straight from where it was, at t = 0, to
// where it is, at t = 1. Boxes between two boxes hold what is between their triangles, so both trees together
// answer for every t.
//
// In the mesh's frame, in metres. Queries allocate nothing.
#pragma once

#include "core/tree/triangle_tree.hpp"

namespace tactus {

// The boxes of the same triangles between two forms.
inline BoxNode between(const BoxNode& from, const BoxNode& to, FloatLanes share) {
    const auto used = from.low[0] <= from.high[0];
    BoxNode node = from;
    for (int axis = 0; axis < 3; ++axis) {
        node.low[axis] += used ? (to.low[axis] - from.low[axis]) * share : splat_float(0.0f);
        node.high[axis] += used ? (to.high[axis] - from.high[axis]) * share : splat_float(0.0f);
    }
    return node;
}

// How much each corner counts in a point of the triangle; each 0 to 1, together 1.
Vec3 weights_of(const Vec3& point, const TriangleCorners& triangle);

class DeformSweep {
public:
    // `to` must be a refit of `from` (see TriangleTree::is_refit_of). Both are used as long as this is.
    DeformSweep(const TriangleTree& from, const TriangleTree& to) : from_(from), to_(to) {}

    // One triangle on its way, seen from a point.
    struct Seen {
        double distance;     // (unit: meters)
        Vec3 offset;         // from its nearest point to the one asked for (unit: meters)
        std::uint32_t slot;  // of the triangle in both trees
    };

    // Calls visit(seen) for the triangles within `limit` of the point at t; visit may lower the limit. Where
    // `work` is used up there may be others.
    template <class Visit>
    void visit_near(double t, const Vec3& point, const double& limit, WorkBudget& work, Visit&& visit) const;

    // How the nearest point of a triangle that was seen goes on, from t = 0 to 1 (unit: meters).
    Vec3 motion_of(const Seen& seen, double t, const Vec3& point) const;

    // The way is free up to here: before, no triangle comes nearer than `room` to a point that is at `point`
    // at t and goes on by `motion` in the time from 0 to 1. At most 1. A lower bound: on from there.
    double free_until(double t, const Vec3& point, const Vec3& motion, double room, WorkBudget& work) const;

private:
    // What single precision may hide of a distance: twice that of one form, and as much between them.
    double slack_at(const Vec3& relative) const {
        return 4.0 * std::max(from_.float_slack(relative), to_.float_slack(relative));
    }
    struct MovingPack {
        TrianglePack at, motion;  // at a time, and from t = 0 to 1 (unit: meters)
    };
    MovingPack pack_at(std::uint32_t index, double t) const;

    const TriangleTree& from_;
    const TriangleTree& to_;
};

template <class Visit>
void DeformSweep::visit_near(double t, const Vec3& point, const double& limit, WorkBudget& work,
                             Visit&& visit) const {
    const Vec3 relative = point - from_.origin_;
    const double slack = slack_at(relative);
    const FloatPoint at = to_float_point(relative);
    const LanesVec3 exact = splat(point);
    const FloatLanes share = splat_float(static_cast<float>(t));
    float bound = square_up(limit + slack);
    from_.visit_best_first(
        bound, work,
        [&](std::uint32_t node) {
            work.spend(cost::box_node);
            return squared_distance_to_boxes(between(from_.nodes_[node], to_.nodes_[node], share), at);
        },
        [&](std::uint32_t pack, float) {
            work.spend(2 * cost::pack_look);
            const PackOffset seen = offset_from_triangles(pack_at(pack, t).at, exact);
            for (int i = 0; i < lane_count; ++i) {
                const double distance = std::sqrt(seen.squared[i]);
                if (distance <= limit) {
                    visit(Seen{distance, lane(seen.offset, i),
                               pack * lane_count + static_cast<std::uint32_t>(i)});
                }
            }
            bound = square_up(limit + slack);
        });
}

}  // namespace tactus
