// Triangles as those see them who judge the proxy: a binary tree of boxes in double, and distances that share
// no line with the product's. All points in the frame of the mesh (unit: meters).
//
// The kernel takes the least of the three edges' distances and, over the face, of the plane's. A sliver whose
// plane is nothing but rounding so still has the right distance: its edges run everywhere along its face.
#pragma once

#include <cstdint>
#include <vector>

#include "shared/slow_distance.hpp"

namespace tactus::shared {

struct JudgedNearest {
    double distance = 0.0;  // `far` where nothing is nearer
    std::uint32_t triangle = 0;
};

class JudgeTree {
public:
    // The mesh must live as long as this, with the same triangles; its corners may move (see moved()).
    explicit JudgeTree(const TriangleMesh& mesh);

    // The corners are elsewhere now.
    void moved();

    JudgedNearest nearest(const Vec3& point, double far) const;

    // Appends every triangle nearer to the point than `reach`, and some that are a little farther.
    void within(const Vec3& point, double reach, std::vector<std::uint32_t>& out) const;

    // The first t in [0, 1] at which start + t * motion goes through a triangle; 2 where it does not.
    double first_crossing(const Vec3& start, const Vec3& motion) const;

    const TriangleMesh& mesh() const { return mesh_; }
    const Vec3& low() const { return nodes_[0].low; }
    const Vec3& high() const { return nodes_[0].high; }
    double magnitude() const { return magnitude_; }  // the largest coordinate

private:
    struct Node {
        Vec3 low, high;
        std::uint32_t first = 0;  // of its triangles in order_, or its left child
        std::uint32_t count = 0;  // 0: an inner node, whose right child stands behind the left one
    };

    void split(std::uint32_t node, std::uint32_t first, std::uint32_t count,
               const std::vector<Vec3>& centers);
    void fit();

    const TriangleMesh& mesh_;
    std::vector<Node> nodes_;  // parents before children
    std::vector<std::uint32_t> order_;
    std::vector<Corners> corners_;  // in that order
    double magnitude_ = 0.0;
};

// Squared distance of a point to a triangle.
double judged_distance_squared(const Vec3& point, const Corners& triangle);

// How often the closed surface winds around the point (van Oosterom and Strackee 1983). Looks at every
// triangle.
int winding(const TriangleMesh& mesh, const Vec3& point);

}  // namespace tactus::shared
