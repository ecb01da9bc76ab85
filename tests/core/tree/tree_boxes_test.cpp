#include "core/tree/tree_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/tree/triangle_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus::tree_boxes_test {
namespace {

bool holds(const TreeBox& box, const Vec3& point) {
    constexpr double rounding = 1e-6;
    return glm::distance(point, glm::clamp(point, box.low, box.high)) < rounding;
}

TEST(TreeBoxes, WhateverIsNearLiesInABoxThatHoldsTriangles) {
    const TriangleMesh mesh = shared::icosphere(4, 0.1);
    const TriangleTree tree = TriangleTree::build(mesh);
    shared::RandomValues random(7);
    for (int round = 0; round < 100; ++round) {
        const Vec3 point = random.in_ball(0.12);
        std::vector<TreeBox> boxes;
        TreeBoxes::around(tree, point, 0.03, 100'000, boxes);
        for (const TreeBox& box : boxes) {
            EXPECT_LE(glm::distance(point, glm::clamp(point, box.low, box.high)), 0.03);
        }
        for (const Vec3& vertex : mesh.vertices) {
            if (glm::distance(vertex, point) < 0.03) {
                const bool is_held = std::any_of(boxes.begin(), boxes.end(), [&](const TreeBox& box) {
                    return box.holds_triangles && holds(box, vertex);
                });
                EXPECT_TRUE(is_held);
            }
        }
    }
}

TEST(TreeBoxes, NoMoreThanAreWantedAndLargerBeforeSmaller) {
    const TriangleTree tree = TriangleTree::build(shared::icosphere(4, 0.1));
    std::vector<TreeBox> all, some;
    TreeBoxes::around(tree, Vec3(0.0), 1.0, 100'000, all);
    TreeBoxes::around(tree, Vec3(0.0), 1.0, 20, some);
    ASSERT_EQ(some.size(), 20u);
    EXPECT_GT(all.size(), tree.pack_count()) << "every pack has a box";
    EXPECT_FALSE(all.front().holds_triangles);
    EXPECT_TRUE(all.back().holds_triangles);
    all.clear();
    TreeBoxes::around(tree, Vec3(5.0), 1.0, 100, all);
    EXPECT_TRUE(all.empty()) << "far away";
}

}  // namespace
}  // namespace tactus::tree_boxes_test
