// Boxes from the leaves up: the last step of a build, and all of it when a mesh deforms.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/triangle_tree.hpp"

namespace tactus {

namespace {

struct Bounds {
    Vec3 low{std::numeric_limits<double>::infinity()};
    Vec3 high{-std::numeric_limits<double>::infinity()};
};

void grow(Bounds& bounds, const LanesVec3& corners) {
    for (int i = 0; i < lane_count; ++i) {
        bounds.low = glm::min(bounds.low, lane(corners, i));
        bounds.high = glm::max(bounds.high, lane(corners, i));
    }
}

// The largest float not above, and the smallest not below.
float round_down(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest > value ? std::nextafterf(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}

float round_up(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest < value ? std::nextafterf(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

void set_box(BoxNode& node, int slot, const Vec3& low, const Vec3& high) {
    for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][slot] = round_down(low[axis]);
        node.high[axis][slot] = round_up(high[axis]);
    }
}

// The box around all children of a node; unused slots are empty and change nothing.
Bounds around(const BoxNode& node) {
    Bounds bounds;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < node_width; ++i) {
            bounds.low[axis] = std::min(bounds.low[axis], static_cast<double>(node.low[axis][i]));
            bounds.high[axis] = std::max(bounds.high[axis], static_cast<double>(node.high[axis][i]));
        }
    }
    return bounds;
}

// What one task has seen of the triangles.
struct Extremes {
    double squared_radius = 0.0;
    double magnitude = 0.0;
};

constexpr std::size_t nodes_a_task = 4096;
constexpr std::size_t packs_a_task = 16384;

}  // namespace

void TriangleTree::place_triangles(const TriangleMesh& mesh, const ParallelRunner& run) {
    const std::size_t count = labels_.size();
    if (!packs_) {
        packs_ = std::make_unique_for_overwrite<TrianglePack[]>(count);
    }
    run_in_parts(run, count, packs_a_task, [&](std::size_t, std::size_t p, std::size_t end) {
        for (; p < end; ++p) {
            LanesVec3* const corners[3] = {&packs_[p].a, &packs_[p].b, &packs_[p].c};
            for (std::size_t i = 0; i < lane_count; ++i) {
                const auto& triangle = mesh.triangles[labels_[p].triangle[i]];
                for (std::size_t k = 0; k < 3; ++k) {
                    const Vec3& corner = mesh.vertices[triangle[k]];
                    corners[k]->x[i] = corner.x;
                    corners[k]->y[i] = corner.y;
                    corners[k]->z[i] = corner.z;
                }
            }
        }
    });
}

void TriangleTree::fit_boxes(const ParallelRunner& run) {
    const std::size_t tasks = (nodes_.size() + nodes_a_task - 1) / nodes_a_task;
    std::vector<Extremes> seen(tasks);
    run(tasks, [&](std::size_t task) {
        const std::size_t end = std::min(nodes_.size(), (task + 1) * nodes_a_task);
        Extremes extremes;
        for (std::size_t n = task * nodes_a_task; n < end; ++n) {
            for (int i = 0; i < node_width; ++i) {
                const std::uint32_t child = nodes_[n].child[i];
                if (child == BoxNode::unused || !(child & BoxNode::leaf_bit)) {
                    continue;
                }
                const TrianglePack& triangles = packs_[child & ~BoxNode::leaf_bit];
                Bounds bounds;
                grow(bounds, triangles.a);
                grow(bounds, triangles.b);
                grow(bounds, triangles.c);
                const Vec3 largest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
                extremes.magnitude = std::max({extremes.magnitude, largest.x, largest.y, largest.z});
                const Vec3 far = glm::max(glm::abs(bounds.low - origin_), glm::abs(bounds.high - origin_));
                extremes.squared_radius = std::max(extremes.squared_radius, glm::dot(far, far));
                set_box(nodes_[n], i, bounds.low - origin_, bounds.high - origin_);
            }
        }
        seen[task] = extremes;
    });
    Extremes all;
    for (const Extremes& part : seen) {
        all.squared_radius = std::max(all.squared_radius, part.squared_radius);
        all.magnitude = std::max(all.magnitude, part.magnitude);
    }
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        for (int i = 0; i < node_width; ++i) {
            const std::uint32_t child = nodes_[n].child[i];
            if (child != BoxNode::unused && !(child & BoxNode::leaf_bit)) {
                const Bounds bounds = around(nodes_[child]);
                set_box(nodes_[n], i, bounds.low, bounds.high);
            }
        }
    }
    const Bounds whole = around(nodes_[0]);
    const Vec3 largest = glm::max(glm::abs(whole.low), glm::abs(whole.high));
    extent_ = std::max({largest.x, largest.y, largest.z});
    radius_ = std::sqrt(all.squared_radius);
    magnitude_ = all.magnitude;
}

TriangleTree TriangleTree::refitted(const TriangleMesh& moved, const ParallelRunner& run) const {
    TriangleTree tree;
    tree.nodes_ = nodes_;
    tree.labels_ = labels_;
    tree.origin_ = origin_;
    tree.triangle_count_ = triangle_count_;
    tree.lineage_ = lineage_;
    tree.refit(moved, run);
    return tree;
}

void TriangleTree::forget_sides(const ParallelRunner& run) {
    run_in_parts(run, labels_.size(), packs_a_task, [&](std::size_t, std::size_t p, std::size_t end) {
        for (; p < end; ++p) {
            PackLabels& labels = labels_[p];
            for (int i = 0; i < lane_count; ++i) {
                std::array<bool, 3> owns{};
                for (std::size_t k = 0; k < 3; ++k) {
                    const EdgeLink other = labels.neighbour[k][i];
                    owns[k] = !other.exists() || labels.triangle[i] < triangle_at(other.triangle());
                }
                labels.owned[i].forget_sides(owns);
            }
        }
    });
}

void TriangleTree::refit(const TriangleMesh& moved, const ParallelRunner& run) {
    forget_sides(run);
    place_triangles(moved, run);
    fit_boxes(run);
}

}  // namespace tactus
