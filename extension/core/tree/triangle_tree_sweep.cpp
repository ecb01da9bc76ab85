// Sweeps of the triangle tree: in one go, nearest boxes first, or pack after pack over several ticks.
#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <limits>

#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

// The largest key of a box that may hold what is met before that. Nothing is met before the start.
float bound_of(const Hit& hit) {
    return hit.t > 0.0 || !hit.found ? static_cast<float>(hit.t * (1.0 + 1e-6))
                                     : -std::numeric_limits<float>::infinity();
}

}  // namespace

FloatWay TriangleTree::to_float_way(const SphereWay& way, double limit) const {
    const Vec3 start = way.start - origin_;
    const Vec3 end = start + way.motion * limit;
    const double rounding = std::max(float_slack(start), float_slack(end));
    const double reach = way.distance + way.slack + rounding;
    // The rate at which a box is neared errs by the rounding of its few operations, and by the angle by which
    // a rounded offset of at least `distance` is turned.
    const double blur = glm::length(way.motion) * (4e-6 + 2.0 * rounding / way.distance);
    return {to_float_point(start),
            to_float_point(end),
            to_float_point(way.motion),
            static_cast<float>(reach * (1.0 + 1e-6)),
            static_cast<float>(blur),
            static_cast<float>(limit),
            static_cast<float>(std::max(point_rounding(start), point_rounding(end))),
            static_cast<float>(1.0 / std::max(glm::length(way.motion), 1e-30))};
}

void TriangleTree::sweep_pack(std::uint32_t pack, const SphereWay& way, Hit& hit, WorkBudget& work) const {
    TrianglePack room;
    const PackHit met = sweep_to_triangles(packs_.at(pack, room), way, hit.t);
    work.spend(met.looks * work.sweep_look());
    if (met.found()) {
        hit.t = met.t;
        hit.found = true;
        hit.triangle = pack * lane_count + static_cast<std::uint32_t>(met.lane);
    }
}

Hit TriangleTree::sweep(const SphereWay& way, double limit, WorkBudget& work) const {
    const FloatWay boxes = to_float_way(way, limit);
    Hit hit;
    hit.t = limit;
    float bound = bound_of(hit);
    const float left_out = visit_best_first(
        bound, work, [&](std::uint32_t node) { return earliest_meeting(nodes_[node], turned_[node], boxes); },
        [&](std::uint32_t pack, float) {
            sweep_pack(pack, way, hit, work);
            bound = bound_of(hit);
        });
    const double known = std::max(0.0, static_cast<double>(left_out) * (1.0 - 1e-6));
    if (left_out <= bound && known < hit.t) {
        hit.t = known;
        hit.found = false;
        hit.complete = false;
    }
    return hit;
}

bool TriangleTree::sweep_on(const SphereWay& way, SweepProgress& progress, WorkBudget& work) const {
    return sweep_node(0, 0, way, to_float_way(way, progress.hit.t), progress, work);
}

bool TriangleTree::sweep_node(std::uint32_t index, std::size_t level, const SphereWay& way,
                              const FloatWay& boxes, SweepProgress& progress, WorkBudget& work) const {
    assert(level < progress.path.size());
    work.spend(cost::box_node);
    const FloatLanes keys = earliest_meeting(nodes_[index], turned_[index], boxes);
    const auto& children = nodes_[index].child;
    for (int k = progress.path[level]; k < node_width; ++k) {
        if (keys[k] <= bound_of(progress.hit) && children[k] & BoxNode::leaf_bit) {
            fetch_pack(children[k] & ~BoxNode::leaf_bit);
        }
    }
    for (std::uint8_t& i = progress.path[level]; i < node_width; ++i) {
        if (!(keys[i] <= bound_of(progress.hit))) {
            // It may have been entered before something nearer was met.
            std::ranges::fill(std::span(progress.path).subspan(level + 1), std::uint8_t{0});
            continue;
        }
        if (work.is_gone()) {
            return false;
        }
        if (children[i] & BoxNode::leaf_bit) {
            sweep_pack(children[i] & ~BoxNode::leaf_bit, way, progress.hit, work);
        } else if (!sweep_node(children[i], level + 1, way, boxes, progress, work)) {
            return false;
        }
    }
    progress.path[level] = 0;
    return true;
}

}  // namespace tactus
