#include "core/tree/triangle_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tactus {

// A query point is rounded to float by at most 2^-24 of itself, its difference to a box side by 2^-24 of
// both; sqrt(3) for three axes. What is relative to the distance is taken off where distances are compared.
double TriangleTree::float_slack(const Vec3& relative) const {
    const double largest = std::max({std::abs(relative.x), std::abs(relative.y), std::abs(relative.z)});
    return 1.75 * 0x1p-24 * (2.0 * largest + extent_);
}

// 2^-24 of each coordinate, and of the middle of a box as it is computed.
double TriangleTree::point_rounding(const Vec3& relative) const {
    const double largest = std::max({std::abs(relative.x), std::abs(relative.y), std::abs(relative.z)});
    return 1.75 * 0x1p-24 * largest;
}

FoundPacks TriangleTree::packs_around(const Vec3& point, double radius, WorkBudget& work,
                                      std::span<FoundPack> out) const {
    const Vec3 relative = point - origin_;
    const double slack = float_slack(relative);
    const float lost = round_up(slack);
    const FloatPoint at = to_float_point(relative);
    const auto rounding = static_cast<float>(point_rounding(relative));
    FoundPacks found;
    BoxPlanes planes;  // of the last node
    float limit = square_up(radius + slack);
    const float left_out = visit_best_first<PackUse::tell>(
        limit, work,
        [&](std::uint32_t node) {
            planes = planes_before(nodes_[node], turned_[node], at, rounding);
            return planes.squared_distance;
        },
        [&](std::uint32_t pack, int slot) {
            const FloatPoint& normal = planes.normal;
            out[found.count++] = {pack,
                                  std::max(0.0f, planes.distance[slot] * (1.0f - 2e-6f) - lost),
                                  {normal.x[slot], normal.y[slot], normal.z[slot]}};
            limit = found.count < out.size() ? limit : -1.0f;
        });
    const double farthest = std::sqrt(static_cast<double>(left_out)) * (1.0 - 1e-6) - slack;
    found.radius = std::min(radius, std::max(0.0, farthest));
    return found;
}

NearestTriangle TriangleTree::nearest(const Vec3& point, double far, WorkBudget& work, double enough) const {
    double least;
    return search(point, {far}, 1.0, enough, least, work);
}

NearestTriangle TriangleTree::nearest(const Vec3& point, double far) const {
    WorkBudget unlimited(std::numeric_limits<std::int64_t>::max());
    return nearest(point, far, unlimited);
}

// Where the boxes of thousands are about as near, the nearest first are all branches before any leaf: the
// first triangle is the one that the nearest child of each node leads to.
NearestTriangle TriangleTree::nearly_nearest(const Vec3& point, double far, double share,
                                             WorkBudget& work) const {
    const std::uint32_t first = pack_down_nearest_boxes(point, work);
    const double distance = distance_to_pack(first, point, work);
    const NearestTriangle known = distance < far ? NearestTriangle{distance, first} : NearestTriangle{far};
    double least;
    return search(point, known, share, 0.0, least, work);
}

// Any will do: what rounding does to the distances changes nothing that is said of it. Unused slots are
// infinitely far.
std::uint32_t TriangleTree::pack_down_nearest_boxes(const Vec3& point, WorkBudget& work) const {
    const FloatPoint at = to_float_point(point - origin_);
    std::uint32_t node = 0;
    while ((node & BoxNode::leaf_bit) == 0) {
        work.spend(cost::box_node);
        const FloatLanes distances = squared_distance(nodes_[node], turned_[node], at, 0.0f);
        int nearest = 0;
        for (int i = 1; i < node_width; ++i) {
            nearest = distances[i] < distances[nearest] ? i : nearest;
        }
        node = nodes_[node].child[nearest];
    }
    return node & ~BoxNode::leaf_bit;
}

double TriangleTree::distance_to_pack(std::uint32_t pack, const Vec3& point, WorkBudget& work) const {
    work.spend(cost::pack_look);
    return std::sqrt(smallest(offset_from_pack(pack, splat(point)).squared));
}

double TriangleTree::least_distance(const Vec3& point, WorkBudget& work) const {
    double least;
    search(point, {1e30}, 0.5, 0.0, least, work);
    return least;
}

// The nearest triangle among what is known and those found when only what may be nearer than `share` of the
// nearest so far is opened, and none once one is nearer than `enough`. `least` is a lower bound of all
// distances.
NearestTriangle TriangleTree::search(const Vec3& point, const NearestTriangle& known, double share,
                                     double enough, double& least, WorkBudget& work) const {
    NearestTriangle nearest = known;
    double limit = share * known.distance;
    const double outside = visit_near(point, limit, work, [&](std::uint32_t pack) {
        const double distance = distance_to_pack(pack, point, work);
        if (distance < nearest.distance) {
            nearest = {distance, pack};
            limit = distance < enough ? 0.0 : share * distance;
        }
    });
    nearest.complete = outside >= limit;
    least = std::min(nearest.distance, outside);
    return nearest;
}

std::size_t TriangleTree::bytes() const {
    return nodes_.size() * (sizeof(BoxNode) + sizeof(TurnedNode)) +
           ids_.size() * (packs_.bytes_each() + sizeof(PackIds));
}

}  // namespace tactus
