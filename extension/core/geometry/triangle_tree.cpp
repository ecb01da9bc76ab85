#include "core/geometry/triangle_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tactus {

namespace {

// Deep enough for every tree the builder makes: its depth is at most 24 wide levels, each leaving 7 siblings
// behind.
constexpr int stack_size = 24 * (node_width - 1) + 1;

struct Pending {
    std::uint32_t node;
    float key;  // what the search prunes by: squared distance, or entry parameter
};

// Children in the order of their keys, nearest on top of the stack; `left_out` follows the least key of those
// beyond the bound.
template <class Visit>
void push_sorted(const BoxNode& node, FloatLanes keys, float bound, const BoxNode* nodes,
                 const TrianglePack* packs, Pending* stack, int& depth, float& left_out, Visit&& leaf) {
    Pending near[node_width];
    int count = 0;
    for (int i = 0; i < node_width; ++i) {
        if (!(keys[i] <= bound)) {
            left_out = std::min(left_out, keys[i]);
            continue;
        }
        int place = count++;
        while (place > 0 && near[place - 1].key < keys[i]) {
            near[place] = near[place - 1];
            --place;
        }
        near[place] = {node.child[i], keys[i]};
        if (node.child[i] & BoxNode::leaf_bit) {
            fetch_early(&packs[node.child[i] & ~BoxNode::leaf_bit], sizeof(TrianglePack));
        } else {
            fetch_early(&nodes[node.child[i]], sizeof(BoxNode));
        }
    }
    // Leaves are answered at once, nearest first: they tighten the bound before any deeper node is opened.
    for (int i = count - 1; i >= 0; --i) {
        if (near[i].node & BoxNode::leaf_bit) {
            leaf(near[i]);
        }
    }
    for (int i = 0; i < count; ++i) {
        if (!(near[i].node & BoxNode::leaf_bit)) {
            stack[depth++] = near[i];
        }
    }
}

// At most the largest float, so that no bound ever takes in the infinite distance of unused slots.
float square_up(double value) {
    const double squared = value * value * (1.0 + 1e-6);
    return static_cast<float>(std::min(squared, 3.4e38));
}

float inverse_for_slabs(double motion) {
    constexpr double tiny = 1e-30;
    return static_cast<float>(1.0 / (std::abs(motion) < tiny ? std::copysign(tiny, motion) : motion));
}

}  // namespace

// Rounding a coordinate difference to float errs by at most 2^-24 of its operands; three axes and the
// rounding of the query point itself stay below four times that.
double TriangleTree::float_slack(const Vec3& relative) const {
    const double largest = std::max({std::abs(relative.x), std::abs(relative.y), std::abs(relative.z)});
    return 4.0 * 0x1p-23 * (largest + extent_);
}

FoundPacks TriangleTree::packs_within(const Vec3& center, double radius, const Vec3& point,
                                      std::span<FoundPack> out) const {
    FoundPacks found;
    const double slack = std::max(float_slack(center - origin_), float_slack(point - origin_));
    const FloatPoint middle = to_float_point(center - origin_);
    const FloatPoint at = to_float_point(point - origin_);
    const float limit = square_up(radius + slack);
    const float rounding = static_cast<float>(slack * (1.0 + 1e-6));

    std::uint32_t stack[stack_size];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const BoxNode& node = nodes_[stack[--depth]];
        const FloatLanes squared = squared_distance_to_boxes(node, at);
        for (unsigned near = lanes_up_to(squared_distance_to_boxes(node, middle), limit); near != 0;
             near &= near - 1) {
            const int i = std::countr_zero(near);
            const std::uint32_t child = node.child[i];
            if (!(child & BoxNode::leaf_bit)) {
                fetch_early(&nodes_[child], sizeof(BoxNode));
                stack[depth++] = child;
            } else if (found.count < out.size()) {
                const float distance = std::sqrt(squared[i]) * (1.0f - 1e-6f) - rounding;
                out[found.count++] = {child & ~BoxNode::leaf_bit, std::max(distance, 0.0f)};
            } else {
                found.complete = false;
                return found;
            }
        }
    }
    return found;
}

NearestTriangle TriangleTree::nearest(const Vec3& point, double far) const {
    double least;
    return search(point, far, 1.0, least);
}

double TriangleTree::least_distance(const Vec3& point) const {
    double least;
    search(point, 1e30, 0.5, least);
    return least;
}

// The nearest triangle among those found when only what may be nearer than `share` of the nearest so far is
// opened. `least` is a lower bound of all distances.
NearestTriangle TriangleTree::search(const Vec3& point, double far, double share, double& least) const {
    NearestTriangle nearest{far};
    const Vec3 relative = point - origin_;
    const double slack = float_slack(relative);
    const FloatPoint at = to_float_point(relative);
    const LanesVec3 exact = splat(point);
    float left_out = std::numeric_limits<float>::infinity();

    auto bound = [&] { return square_up(share * nearest.distance + slack); };
    auto leaf = [&](const Pending& item) {
        if (!(item.key <= bound())) {
            left_out = std::min(left_out, item.key);
            return;
        }
        const std::uint32_t index = item.node & ~BoxNode::leaf_bit;
        const double distance = std::sqrt(smallest(offset_from_triangles(packs_[index], exact).squared));
        if (distance < nearest.distance) {
            nearest = {distance, index};
        }
    };

    Pending stack[stack_size];
    int depth = 0;
    stack[depth++] = {0, 0.0f};
    while (depth > 0) {
        const Pending item = stack[--depth];
        const float limit = bound();
        if (!(item.key <= limit)) {
            left_out = std::min(left_out, item.key);
            continue;
        }
        const BoxNode& node = nodes_[item.node];
        push_sorted(node, squared_distance_to_boxes(node, at), limit, nodes_.data(), packs_.get(), stack,
                    depth, left_out, leaf);
    }
    const double outside = std::sqrt(static_cast<double>(left_out)) * (1.0 - 1e-6) - slack;
    least = std::max(0.0, std::min(nearest.distance, outside));
    return nearest;
}

double TriangleTree::sweep(const Vec3& start, const Vec3& motion, double distance, double slack, double limit,
                           Work& work) const {
    const Vec3 relative = start - origin_;
    const Vec3 end = relative + motion * limit;
    const double rounding = std::max(float_slack(relative), float_slack(end));
    const float margin = static_cast<float>((distance + slack + rounding) * (1.0 + 1e-6));
    const FloatRay ray{to_float_point(relative),
                       {splat_float(inverse_for_slabs(motion.x)), splat_float(inverse_for_slabs(motion.y)),
                        splat_float(inverse_for_slabs(motion.z))}};
    double best = limit;
    bool found = false;
    float left_out = 0.0f;  // nobody asks
    auto bound = [&] { return static_cast<float>(best * (1.0 + 1e-6)); };
    auto leaf = [&](const Pending& item) {
        if (!(item.key <= bound())) {
            return;
        }
        const TrianglePack& triangles = packs_[item.node & ~BoxNode::leaf_bit];
        work -= sweep_work;
        const double t = sweep_to_triangles(triangles, start, motion, distance, slack, best);
        if (t <= best) {
            best = t;
            found = true;
        }
    };

    Pending stack[stack_size];
    int depth = 0;
    stack[depth++] = {0, 0.0f};
    while (depth > 0) {
        const Pending item = stack[--depth];
        const float reach = bound();
        if (!(item.key <= reach)) {
            continue;
        }
        if (--work <= 0) {  // nothing that is left is entered before the first of those pending
            double free = std::min(best, static_cast<double>(item.key));
            for (int i = 0; i < depth; ++i) {
                free = std::min(free, static_cast<double>(stack[i].key));
            }
            return free * (1.0 - 1e-5);
        }
        const BoxNode& node = nodes_[item.node];
        push_sorted(node, entry_into_boxes(node, ray, margin, reach), reach, nodes_.data(), packs_.get(),
                    stack, depth, left_out, leaf);
    }
    return found ? best : 2.0 * limit + 1.0;
}

std::size_t TriangleTree::bytes() const {
    return nodes_.size() * sizeof(BoxNode) + labels_.size() * (sizeof(TrianglePack) + sizeof(PackLabels));
}

}  // namespace tactus
