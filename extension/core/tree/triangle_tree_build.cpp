// Building the triangle tree, eight children a node straight away. The triangles come sorted into the cells
// of a grid; their subtrees are built side by side. All borders are fixed, so that the tree is the same
// whatever the number of threads.
#include <algorithm>
#include <array>
#include <atomic>

#include "core/tree/tree_cells.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

// A subtree under construction: its node children count from its own first node and pack.
struct Subtree {
    Range range;
    int level = 0;             // of its first node
    std::uint32_t parent = 0;  // node that it belongs to
    int slot = 0;              // of that node
    std::vector<BoxNode> nodes;
    std::vector<PackIds> packs;
};

class SubtreeBuilder {
public:
    explicit SubtreeBuilder(const SortedTriangles& sorted)
        : primitives_(sorted.primitives.get()), splitter_(sorted.primitives.get(), sorted.cells) {}

    // Adds the nodes of a range. Parts of at most `later` triangles are left to be built: their slots stay
    // unused.
    std::uint32_t build(const Range& range, int level, Subtree& tree, std::size_t later = 0,
                        std::vector<Subtree>* left_over = nullptr) const {
        const auto index = static_cast<std::uint32_t>(tree.nodes.size());
        tree.nodes.push_back(empty_node());
        std::array<Range, node_width> children;
        const int count = open_children(range, level, children);
        for (int i = 0; i < count; ++i) {
            const Range& child = children[static_cast<std::size_t>(i)];
            if (child.is_leaf()) {
                tree.nodes[index].child[i] = add_pack(child, tree);
            } else if (child.size() <= later) {
                left_over->push_back({child, level + 1, index, i, {}, {}});
            } else {
                const std::uint32_t node = build(child, level + 1, tree, later, left_over);
                tree.nodes[index].child[i] = node;
            }
        }
        return index;
    }

private:
    // Opens the child with the largest surface until there are eight, or only such as fit into one node of
    // their own. Deep down it is the one with the most triangles: then each level leaves an eighth.
    int open_children(const Range& range, int level, std::array<Range, node_width>& children) const {
        const bool is_deep = level >= TreeSplitter::heuristic_levels;
        children[0] = range;
        int count = 1;
        while (count < node_width) {
            int widest = -1;
            float area = -1.0f;
            for (int i = 0; i < count; ++i) {
                const Range& child = children[static_cast<std::size_t>(i)];
                const float own = is_deep ? static_cast<float>(child.size()) : child.bounds.area();
                const bool is_closed = child.size() <= (range.size() > node_full ? node_full : lane_count);
                if (!is_closed && own > area) {
                    widest = i;
                    area = own;
                }
            }
            if (widest < 0) {
                break;
            }
            Range left, right;
            splitter_.split(children[static_cast<std::size_t>(widest)], level, left, right);
            children[static_cast<std::size_t>(widest)] = left;
            children[static_cast<std::size_t>(count++)] = right;
        }
        while (open_into_packs(smallest_node(children, count), level, children, count)) {
        }
        return count;
    }

    // Of the children that would need a node of their own, the one with the fewest triangles; -1: none.
    static int smallest_node(const std::array<Range, node_width>& children, int count) {
        int smallest = -1;
        for (int i = 0; i < count; ++i) {
            const std::size_t size = children[static_cast<std::size_t>(i)].size();
            if (size > lane_count &&
                (smallest < 0 || size < children[static_cast<std::size_t>(smallest)].size())) {
                smallest = i;
            }
        }
        return smallest;
    }

    // A small child's packs stand in its parent, where they find room there: a node less. False where not.
    bool open_into_packs(int child, int level, std::array<Range, node_width>& children, int& count) const {
        const std::size_t size = child < 0 ? 0 : children[static_cast<std::size_t>(child)].size();
        const std::size_t packs = (size + lane_count - 1) / lane_count;
        if (size == 0 || static_cast<std::size_t>(count) - 1 + packs > node_width) {
            return false;
        }
        const int first_new = count;
        for (int i = child; i < count; i = i == child ? first_new : i + 1) {
            while (!children[static_cast<std::size_t>(i)].is_leaf()) {
                Range left, right;
                splitter_.split(children[static_cast<std::size_t>(i)], level, left, right);
                children[static_cast<std::size_t>(i)] = left;
                children[static_cast<std::size_t>(count++)] = right;
            }
        }
        return true;
    }

    static BoxNode empty_node() {
        BoxNode node;
        for (int axis = 0; axis < 3; ++axis) {
            node.low[axis] = splat_float(infinite);
            node.high[axis] = splat_float(-infinite);
        }
        std::fill(std::begin(node.child), std::end(node.child), BoxNode::unused);
        return node;
    }

    std::uint32_t add_pack(const Range& range, Subtree& tree) const {
        PackIds ids;
        for (std::size_t i = 0; i < lane_count; ++i) {
            ids[i] = primitives_[std::min(range.begin + i, range.end - 1)].id();
        }
        tree.packs.push_back(ids);
        return static_cast<std::uint32_t>(tree.packs.size() - 1) | BoxNode::leaf_bit;
    }

    const Primitive* primitives_;
    TreeSplitter splitter_;
};

}  // namespace

// Large meshes in some hundred parts.
void TriangleTree::place_nodes(const TriangleMesh& mesh, const CornerExtent& extent,
                               const ParallelRunner& run) {
    constexpr std::size_t least_part = 8192;
    const SortedTriangles sorted = sort_into_cells(mesh, extent, origin_, run);
    const SubtreeBuilder builder(sorted);
    const std::size_t part = std::max(least_part, mesh.triangles.size() / 256);
    Subtree top;
    std::vector<Subtree> parts;
    builder.build(sorted.cells[1], 0, top, part, &parts);
    run(parts.size(), [&](std::size_t i) { builder.build(parts[i].range, parts[i].level, parts[i]); });

    std::size_t node_count = top.nodes.size();
    std::size_t pack_count = top.packs.size();
    for (Subtree& subtree : parts) {
        top.nodes[subtree.parent].child[subtree.slot] = static_cast<std::uint32_t>(node_count);
        node_count += subtree.nodes.size();
        pack_count += subtree.packs.size();
    }
    nodes_ = std::move(top.nodes);
    nodes_.reserve(node_count);
    ids_.reserve(pack_count);
    const auto add_packs = [&](const Subtree& subtree) {
        ids_.insert(ids_.end(), subtree.packs.begin(), subtree.packs.end());
    };
    add_packs(top);
    for (const Subtree& subtree : parts) {
        const auto first_node = static_cast<std::uint32_t>(nodes_.size());
        const auto first_pack = static_cast<std::uint32_t>(ids_.size());
        for (BoxNode node : subtree.nodes) {
            for (std::uint32_t& child : node.child) {
                child += child == BoxNode::unused ? 0 : (child & BoxNode::leaf_bit ? first_pack : first_node);
            }
            nodes_.push_back(node);
        }
        add_packs(subtree);
    }
}

TriangleTree TriangleTree::build(const TriangleMesh& mesh, const ParallelRunner& run) {
    static std::atomic<std::uint64_t> last_lineage{0};
    const CornerExtent extent = corner_extent(mesh, run);
    TriangleTree tree;
    tree.triangle_count_ = mesh.triangles.size();
    tree.origin_ = 0.5 * (extent.low + extent.high);
    tree.place_nodes(mesh, extent, run);
    tree.place_triangles(mesh, extent.is_single, run);
    tree.fit_boxes(run);
    tree.lineage_ = ++last_lineage;
    return tree;
}

}  // namespace tactus
