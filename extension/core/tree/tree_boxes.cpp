#include "core/tree/tree_boxes.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/tree/triangle_tree.hpp"

namespace tactus {

void TreeBoxes::around(const TriangleTree& tree, const Vec3& point, double radius, std::size_t most,
                       std::vector<TreeBox>& out) {
    if (tree.nodes_.empty()) {
        return;
    }
    std::vector<std::uint32_t> open{0};
    for (std::size_t next = 0; next < open.size(); ++next) {
        const BoxNode& node = tree.nodes_[open[next]];
        for (int i = 0; i < node_width; ++i) {
            const std::uint32_t child = node.child[i];
            if (child == BoxNode::unused) {
                continue;
            }
            const Vec3 low = tree.origin_ + Vec3(node.low[0][i], node.low[1][i], node.low[2][i]);
            const Vec3 high = tree.origin_ + Vec3(node.high[0][i], node.high[1][i], node.high[2][i]);
            if (glm::distance(point, glm::clamp(point, low, high)) > radius) {
                continue;
            }
            if (out.size() >= most) {
                return;
            }
            const bool is_leaf = (child & BoxNode::leaf_bit) != 0;
            out.push_back({low, high, is_leaf});
            if (!is_leaf) {
                open.push_back(child);
            }
        }
    }
}

}  // namespace tactus
