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

}  // namespace

void TriangleTree::refit_bounds() {
    double squared_radius = 0.0;
    magnitude_ = 0.0;
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        BoxNode& node = nodes_[n];
        for (int i = 0; i < node_width; ++i) {
            if (node.child[i] == BoxNode::unused) {
                continue;
            }
            Bounds bounds;
            if (node.child[i] & BoxNode::leaf_bit) {
                const TrianglePack& triangles = packs_[node.child[i] & ~BoxNode::leaf_bit];
                grow(bounds, triangles.a);
                grow(bounds, triangles.b);
                grow(bounds, triangles.c);
                const Vec3 largest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
                magnitude_ = std::max({magnitude_, largest.x, largest.y, largest.z});
                bounds.low -= origin_;
                bounds.high -= origin_;
                const Vec3 far = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
                squared_radius = std::max(squared_radius, glm::dot(far, far));
            } else {
                bounds = around(nodes_[node.child[i]]);
            }
            set_box(node, i, bounds.low, bounds.high);
        }
    }
    const Bounds all = around(nodes_[0]);
    const Vec3 largest = glm::max(glm::abs(all.low), glm::abs(all.high));
    extent_ = std::max({largest.x, largest.y, largest.z});
    radius_ = std::sqrt(squared_radius);
}

void TriangleTree::refit(const TriangleMesh& moved) {
    for (std::size_t p = 0; p < packs_.size(); ++p) {
        LanesVec3* const corners[3] = {&packs_[p].a, &packs_[p].b, &packs_[p].c};
        for (std::size_t i = 0; i < lane_count; ++i) {
            const auto& triangle = moved.triangles[ids_[p * lane_count + i]];
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3& corner = moved.vertices[triangle[k]];
                corners[k]->x[i] = corner.x;
                corners[k]->y[i] = corner.y;
                corners[k]->z[i] = corner.z;
            }
        }
    }
    refit_bounds();
}

}  // namespace tactus
