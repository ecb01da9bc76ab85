// The boxes of a triangle tree, for the eye: what a search around a point opens.
#pragma once

#include <vector>

#include "core/math/types.hpp"

namespace tactus {

class TriangleTree;

struct TreeBox {
    Vec3 low{0.0}, high{0.0};      // in the mesh's own frame (unit: meters)
    bool holds_triangles = false;  // else boxes
};

class TreeBoxes {
public:
    // Appends those that are no farther from the point than that, parents before children, until there are
    // `most`.
    static void around(const TriangleTree& tree, const Vec3& point, double radius, std::size_t most,
                       std::vector<TreeBox>& out);
};

}  // namespace tactus
