// Boxes from the leaves up: the last step of a build, and all of it when a mesh deforms.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/tree/triangle_tree.hpp"

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

constexpr std::size_t triangles_a_task = std::size_t{1} << 16;
constexpr std::size_t nodes_a_refit_task = 4096;
constexpr std::size_t packs_a_task = 16384;

}  // namespace

// By its bits, which no compiler rounds away. Numbers that single precision holds with fewer digits do not
// count.
bool is_single(double value) {
    const double size = std::abs(value);
    const bool in_range =
        size >= std::numeric_limits<float>::min() && size <= std::numeric_limits<float>::max();
    return size == 0.0 || (in_range && (std::bit_cast<std::uint64_t>(value) & 0x1fff'ffffu) == 0);
}

// Of the corners, not of all vertices: one that no triangle uses may be anywhere.
CornerExtent corner_extent(const TriangleMesh& mesh, const ParallelRunner& run) {
    const std::size_t count = mesh.triangles.size();
    std::vector<CornerExtent> partial((count + triangles_a_task - 1) / triangles_a_task);
    run_in_parts(run, count, triangles_a_task, [&](std::size_t part, std::size_t i, std::size_t end) {
        CornerExtent extent;
        for (; i < end; ++i) {
            for (const std::uint32_t corner : mesh.triangles[i]) {
                const Vec3& place = mesh.vertices[corner];
                extent.low = glm::min(extent.low, place);
                extent.high = glm::max(extent.high, place);
                extent.is_single &= is_single(place.x) && is_single(place.y) && is_single(place.z);
            }
        }
        partial[part] = extent;
    });
    CornerExtent all;
    for (const CornerExtent& part : partial) {
        all.low = glm::min(all.low, part.low);
        all.high = glm::max(all.high, part.high);
        all.is_single &= part.is_single;
    }
    return all;
}

void TriangleTree::place_triangles(const TriangleMesh& mesh, bool single, const ParallelRunner& run) {
    packs_.reset(ids_.size(), single);
    run_in_parts(run, ids_.size(), packs_a_task, [&](std::size_t, std::size_t p, std::size_t end) {
        for (; p < end; ++p) {
            place_pack(p, mesh);
        }
    });
}

void TriangleTree::place_pack(std::size_t index, const TriangleMesh& mesh) {
    TrianglePack pack;
    LanesVec3* const corners[3] = {&pack.a, &pack.b, &pack.c};
    for (std::size_t i = 0; i < lane_count; ++i) {
        const auto& triangle = mesh.triangles[ids_[index][i]];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& corner = mesh.vertices[triangle[k]];
            corners[k]->x[i] = corner.x;
            corners[k]->y[i] = corner.y;
            corners[k]->z[i] = corner.z;
        }
    }
    packs_.set(index, pack);
}

void TriangleTree::fit_boxes(const ParallelRunner& run) {
    const std::size_t tasks = (nodes_.size() + nodes_a_refit_task - 1) / nodes_a_refit_task;
    std::vector<Extremes> seen(tasks);
    run(tasks, [&](std::size_t task) {
        seen[task] =
            fit_leaves(task * nodes_a_refit_task, std::min(nodes_.size(), (task + 1) * nodes_a_refit_task));
    });
    Extremes all;
    for (const Extremes& part : seen) {
        all.squared_radius = std::max(all.squared_radius, part.squared_radius);
        all.magnitude = std::max(all.magnitude, part.magnitude);
    }
    fit_inner(all);
    fit_turned_boxes(run);
}

TriangleTree::Extremes TriangleTree::fit_leaves(std::size_t first_node, std::size_t end) {
    Extremes extremes;
    for (std::size_t n = first_node; n < end; ++n) {
        for (int i = 0; i < node_width; ++i) {
            const std::uint32_t child = nodes_[n].child[i];
            if (child == BoxNode::unused || !(child & BoxNode::leaf_bit)) {
                continue;
            }
            TrianglePack room;
            const TrianglePack& triangles = packs_.at(child & ~BoxNode::leaf_bit, room);
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
    return extremes;
}

void TriangleTree::fit_inner(const Extremes& all) {
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
    tree.ids_ = ids_;
    tree.origin_ = origin_;
    tree.triangle_count_ = triangle_count_;
    tree.lineage_ = lineage_;
    tree.refit(moved, run);
    return tree;
}

void TriangleTree::refit(const TriangleMesh& moved, const ParallelRunner& run) {
    place_triangles(moved, corner_extent(moved, run).is_single, run);
    fit_boxes(run);
}

void TriangleTree::follow(const TriangleMesh& moved) {
    packs_.reset(ids_.size(), false);
    for (std::size_t p = 0; p < ids_.size(); ++p) {
        place_pack(p, moved);
    }
    fit_inner(fit_leaves(0, nodes_.size()));
    turned_.assign(nodes_.size(), TurnedNode{});
}

}  // namespace tactus
