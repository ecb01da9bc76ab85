// Building the triangle tree: binned surface-area heuristic for large ranges, medians that fill packs for
// small ones, eight children a node straight away. Chunks and subtrees have fixed borders, so that the tree
// is the same whatever the number of threads.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

#include "core/geometry/mesh_features.hpp"
#include "core/geometry/triangle_tree.hpp"

namespace tactus {

namespace {

using Float4 = float __attribute__((vector_size(16)));

constexpr float infinity = std::numeric_limits<float>::infinity();

Float4 lower(Float4 a, Float4 b) {
    return a < b ? a : b;
}
Float4 upper(Float4 a, Float4 b) {
    return a > b ? a : b;
}

struct Box {
    Float4 low{infinity, infinity, infinity, 0.0f};
    Float4 high{-infinity, -infinity, -infinity, 0.0f};

    void grow(const Box& other) {
        low = lower(low, other.low);
        high = upper(high, other.high);
    }
    void grow(Float4 point) {
        low = lower(low, point);
        high = upper(high, point);
    }
    // Half the surface: what the heuristic compares.
    float area() const {
        const Float4 size = high - low;
        return size[0] < 0.0f ? 0.0f : size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
    }
};

struct Primitive {
    Float4 low, high;  // corners of its box; the w lanes hold the triangle's index (low) and nothing (high)

    std::uint32_t id() const {
        const float bits = low[3];
        std::uint32_t index;
        __builtin_memcpy(&index, &bits, sizeof index);
        return index;
    }
    void set_id(std::uint32_t index) {
        float bits;
        __builtin_memcpy(&bits, &index, sizeof bits);
        low[3] = bits;
    }
    Float4 doubled_center() const {
        Float4 center = low + high;
        center[3] = 0.0f;
        return center;
    }
    Box bounds() const {
        Box plain{low, high};
        plain.low[3] = 0.0f;
        plain.high[3] = 0.0f;
        return plain;
    }
};

struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
    Box bounds;   // of the triangles
    Box centers;  // of their doubled centres

    std::size_t size() const { return end - begin; }
    bool is_leaf() const { return size() <= lane_count; }
};

constexpr int bin_count = 16;
constexpr std::size_t chunk = std::size_t{1} << 16;  // triangles a task looks at when a large range is split
constexpr std::size_t median_below = 24;  // at or below, a median that fills packs beats the heuristic
constexpr std::size_t halves_above = 2048;
constexpr int heuristic_levels = 8;  // below this depth only medians: bounds the depth of the tree

struct Bins {
    std::array<std::array<Box, bin_count>, 3> box;
    std::array<std::array<std::uint32_t, bin_count>, 3> count{};

    void merge(const Bins& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < bin_count; ++i) {
                box[axis][i].grow(other.box[axis][i]);
                count[axis][i] += other.count[axis][i];
            }
        }
    }
};

int longest_axis(Float4 size) {
    return size[0] >= size[1] && size[0] >= size[2] ? 0 : (size[1] >= size[2] ? 1 : 2);
}

// Maps a doubled centre to its bin on all three axes.
struct BinScale {
    Float4 low;
    Float4 factor;

    explicit BinScale(const Box& centers) : low(centers.low) {
        constexpr float thin = 1e-30f;  // (unit: meters); the inverse of less may be infinite
        const Float4 size = centers.high - centers.low;
        for (int axis = 0; axis < 4; ++axis) {
            factor[axis] =
                axis < 3 && size[axis] > thin ? static_cast<float>(bin_count) * 0.9999f / size[axis] : 0.0f;
        }
    }
    auto bins_of(Float4 center) const {
        using Int4 = std::int32_t __attribute__((vector_size(16)));
        return __builtin_convertvector((center - low) * factor, Int4);
    }
};

struct Split {
    int axis = -1;
    int bin = 0;  // bins up to and including this one go left
    Box left, right;
    float cost = infinity;
};

Split best_split(const Bins& bins) {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
        const auto& box = bins.box[static_cast<std::size_t>(axis)];
        const auto& count = bins.count[static_cast<std::size_t>(axis)];
        std::array<Box, bin_count> from_right;
        std::array<std::uint32_t, bin_count> right_count{};
        Box grown;
        std::uint32_t counted = 0;
        for (std::size_t i = bin_count; i-- > 1;) {
            grown.grow(box[i]);
            counted += count[i];
            from_right[i] = grown;
            right_count[i] = counted;
        }
        grown = Box{};
        counted = 0;
        for (std::size_t i = 0; i + 1 < bin_count; ++i) {
            grown.grow(box[i]);
            counted += count[i];
            if (counted == 0 || right_count[i + 1] == 0) {
                continue;
            }
            const float cost = grown.area() * static_cast<float>(counted) +
                               from_right[i + 1].area() * static_cast<float>(right_count[i + 1]);
            if (cost < best.cost) {
                best = {axis, static_cast<int>(i), grown, from_right[i + 1], cost};
            }
        }
    }
    return best;
}

}  // namespace

class TriangleTreeBuilder {
public:
    TriangleTreeBuilder(const TriangleMesh& mesh, const ParallelRunner& run) : mesh_(mesh), run_(run) {}

    TriangleTree build() {
        TriangleTree tree;
        tree.triangle_count_ = mesh_.triangles.size();
        place_origin(tree);
        Range all = make_primitives();
        build_nodes(tree, all);
        primitives_.reset();
        tree.place_features(mesh_, run_);
        tree.place_triangles(mesh_, run_);
        tree.fit_boxes(run_);
        return tree;
    }

private:
    // A subtree under construction: node children count from the subtree's own first node and pack.
    struct Part {
        std::vector<BoxNode> nodes;
        std::vector<std::array<std::uint32_t, lane_count>> packs;
    };

    // The first two levels of a large mesh: their ranges, while the subtrees below are built elsewhere.
    struct Branch {
        std::array<Range, node_width> children;
        int count = 0;
    };

    void place_origin(TriangleTree& tree) {
        // The middle of the corners, not of the vertices: one that no triangle uses may be anywhere.
        struct Extent {
            Vec3 low{std::numeric_limits<double>::infinity()};
            Vec3 high{-std::numeric_limits<double>::infinity()};
        };
        const std::size_t count = mesh_.triangles.size();
        std::vector<Extent> partial((count + chunk - 1) / chunk);
        run_in_parts(run_, count, chunk, [&](std::size_t part, std::size_t i, std::size_t end) {
            Extent extent;
            for (; i < end; ++i) {
                for (const std::uint32_t corner : mesh_.triangles[i]) {
                    extent.low = glm::min(extent.low, mesh_.vertices[corner]);
                    extent.high = glm::max(extent.high, mesh_.vertices[corner]);
                }
            }
            partial[part] = extent;
        });
        Extent all;
        for (const Extent& part : partial) {
            all.low = glm::min(all.low, part.low);
            all.high = glm::max(all.high, part.high);
        }
        tree.origin_ = 0.5 * (all.low + all.high);
        origin_ = tree.origin_;
    }

    Float4 to_float(const Vec3& point) const {
        const Vec3 relative = point - origin_;
        return Float4{static_cast<float>(relative.x), static_cast<float>(relative.y),
                      static_cast<float>(relative.z), 0.0f};
    }

    Range make_primitives() {
        const std::size_t count = mesh_.triangles.size();
        primitives_ = std::make_unique_for_overwrite<Primitive[]>(count);
        const std::size_t chunks = (count + chunk - 1) / chunk;
        std::vector<Range> partial(chunks);
        run_(chunks, [&](std::size_t c) {
            const std::size_t end = std::min(count, (c + 1) * chunk);
            for (std::size_t i = c * chunk; i < end; ++i) {
                const auto& [a, b, d] = mesh_.triangles[i];
                Box box;
                box.grow(to_float(mesh_.vertices[a]));
                box.grow(to_float(mesh_.vertices[b]));
                box.grow(to_float(mesh_.vertices[d]));
                partial[c].bounds.grow(box);
                primitives_[i] = {box.low, box.high};
                partial[c].centers.grow(primitives_[i].doubled_center());
                primitives_[i].set_id(static_cast<std::uint32_t>(i));
            }
        });
        Range all{0, count, {}, {}};
        for (const Range& part : partial) {
            all.bounds.grow(part.bounds);
            all.centers.grow(part.centers);
        }
        return all;
    }

    Bins fill_bins(const BinScale& scale, std::size_t begin, std::size_t end) const {
        Bins bins;
        for (std::size_t i = begin; i < end; ++i) {
            const Primitive& primitive = primitives_[i];
            const Box box = primitive.bounds();
            const auto bin = scale.bins_of(primitive.doubled_center());
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto b = static_cast<std::size_t>(bin[axis]);
                bins.box[axis][b].grow(box);
                ++bins.count[axis][b];
            }
        }
        return bins;
    }

    Bins count_bins(const Range& range, const BinScale& scale, const ParallelRunner& run) const {
        const std::size_t chunks = (range.size() + chunk - 1) / chunk;
        if (chunks <= 1) {
            return fill_bins(scale, range.begin, range.end);
        }
        std::vector<Bins> partial(chunks);
        run(chunks, [&](std::size_t c) {
            const std::size_t begin = range.begin + c * chunk;
            partial[c] = fill_bins(scale, begin, std::min(range.end, begin + chunk));
        });
        for (std::size_t c = 1; c < chunks; ++c) {
            partial[0].merge(partial[c]);
        }
        return partial[0];
    }

    Box centers_of(std::size_t begin, std::size_t end) const {
        Box centers;
        for (std::size_t i = begin; i < end; ++i) {
            centers.grow(primitives_[i].doubled_center());
        }
        return centers;
    }

    Box bounds_of(std::size_t begin, std::size_t end) const {
        Box bounds;
        for (std::size_t i = begin; i < end; ++i) {
            bounds.grow(primitives_[i].bounds());
        }
        return bounds;
    }

    // Halves along the longest side, with a whole number of packs on the left.
    void split_at_median(const Range& range, Range& left, Range& right) {
        const Float4 size = range.centers.high - range.centers.low;
        const int axis = longest_axis(size);
        const std::size_t packs = (range.size() + lane_count - 1) / lane_count;
        const std::size_t middle = range.begin + (packs / 2) * lane_count;
        Primitive* const first = primitives_.get();
        std::nth_element(first + range.begin, first + middle, first + range.end,
                         [axis](const Primitive& p, const Primitive& q) {
                             const float a = p.doubled_center()[axis];
                             const float b = q.doubled_center()[axis];
                             return a < b || (a == b && p.id() < q.id());
                         });
        left = {range.begin, middle, bounds_of(range.begin, middle), centers_of(range.begin, middle)};
        right = {middle, range.end, bounds_of(middle, range.end), centers_of(middle, range.end)};
    }

    // Halves the space of the centres along its longest side: where triangles are spread evenly the heuristic
    // comes to the same, at twice the cost. False where they are not.
    bool split_in_the_middle(const Range& range, Range& left, Range& right) {
        const Float4 size = range.centers.high - range.centers.low;
        const int axis = longest_axis(size);
        const float middle = range.centers.low[axis] + 0.5f * size[axis];
        const std::size_t border =
            partition(range, [&](Float4 center) { return center[axis] < middle; }, left, right);
        return std::min(border - range.begin, range.end - border) >= range.size() / 8;
    }

    void split(const Range& range, int level, const ParallelRunner& run, Range& left, Range& right) {
        if (range.size() <= median_below || level >= heuristic_levels) {
            split_at_median(range, left, right);
            return;
        }
        if (range.size() > halves_above && split_in_the_middle(range, left, right)) {
            return;
        }
        const BinScale scale(range.centers);
        const Split best = best_split(count_bins(range, scale, run));
        if (best.axis < 0) {  // all centres in one bin
            split_at_median(range, left, right);
            return;
        }
        partition(
            range, [&](Float4 center) { return scale.bins_of(center)[best.axis] <= best.bin; }, left, right);
    }

    // A stable order is not needed, a repeatable one is: this is a plain function of its input.
    template <class GoesLeft>
    std::size_t partition(const Range& range, GoesLeft&& goes_left, Range& left, Range& right) {
        left = right = Range{};
        Primitive* low = primitives_.get() + range.begin;
        Primitive* high = primitives_.get() + range.end;
        const auto take = [](Range& side, const Primitive& primitive) {
            side.bounds.grow(primitive.bounds());
            side.centers.grow(primitive.doubled_center());
        };
        while (low < high) {
            if (goes_left(low->doubled_center())) {
                take(left, *low++);
                continue;
            }
            take(right, *low);
            std::swap(*low, *--high);
        }
        const auto border = static_cast<std::size_t>(low - primitives_.get());
        left.begin = range.begin;
        left.end = right.begin = border;
        right.end = range.end;
        return border;
    }

    // Opens the child with the largest surface until there are eight, or only leaves.
    int open_children(const Range& range, int level, const ParallelRunner& run,
                      std::array<Range, node_width>& children) {
        children[0] = range;
        int count = 1;
        while (count < node_width) {
            int widest = -1;
            float area = -1.0f;
            for (int i = 0; i < count; ++i) {
                const Range& child = children[static_cast<std::size_t>(i)];
                if (!child.is_leaf() && child.bounds.area() > area) {
                    widest = i;
                    area = child.bounds.area();
                }
            }
            if (widest < 0) {
                break;
            }
            Range left, right;
            split(children[static_cast<std::size_t>(widest)], level, run, left, right);
            children[static_cast<std::size_t>(widest)] = left;
            children[static_cast<std::size_t>(count++)] = right;
        }
        return count;
    }

    static BoxNode empty_node() {
        BoxNode node;
        for (int axis = 0; axis < 3; ++axis) {
            node.low[axis] = splat_float(infinity);
            node.high[axis] = splat_float(-infinity);
        }
        std::fill(std::begin(node.child), std::end(node.child), BoxNode::unused);
        return node;
    }

    std::uint32_t add_pack(const Range& range, Part& part) const {
        std::array<std::uint32_t, lane_count> ids;
        for (std::size_t i = 0; i < lane_count; ++i) {
            ids[i] = primitives_[std::min(range.begin + i, range.end - 1)].id();
        }
        part.packs.push_back(ids);
        return static_cast<std::uint32_t>(part.packs.size() - 1) | BoxNode::leaf_bit;
    }

    std::uint32_t build_part(const Range& range, int level, Part& part) {
        const auto index = static_cast<std::uint32_t>(part.nodes.size());
        part.nodes.push_back(empty_node());
        std::array<Range, node_width> children;
        const int count = open_children(range, level, serial_, children);
        for (int i = 0; i < count; ++i) {
            const Range& child = children[static_cast<std::size_t>(i)];
            const std::uint32_t reference =
                child.is_leaf() ? add_pack(child, part) : build_part(child, level + 1, part);
            part.nodes[index].child[i] = reference;
        }
        return index;
    }

    // Small meshes are built in one go; of large ones, 64 subtrees side by side.
    void build_nodes(TriangleTree& tree, const Range& all) {
        if (all.size() < 4 * chunk / node_width) {
            Part whole;
            build_part(all, 0, whole);
            append(tree, whole, 0);
            return;
        }
        std::array<Range, node_width> children;
        const int count = open_children(all, 0, run_, children);
        std::vector<Branch> branches(static_cast<std::size_t>(count));
        std::vector<Part> parts(static_cast<std::size_t>(count) * node_width);
        run_(branches.size(), [&](std::size_t b) {
            if (!children[b].is_leaf()) {
                branches[b].count = open_children(children[b], 1, serial_, branches[b].children);
            }
        });
        run_(parts.size(), [&](std::size_t p) {
            const Branch& branch = branches[p / node_width];
            const auto slot = static_cast<int>(p % node_width);
            if (slot < branch.count && !branch.children[static_cast<std::size_t>(slot)].is_leaf()) {
                build_part(branch.children[static_cast<std::size_t>(slot)], 2, parts[p]);
            }
        });
        assemble(tree, children, count, branches, parts);
    }

    void assemble(TriangleTree& tree, const std::array<Range, node_width>& children, int count,
                  const std::vector<Branch>& branches, const std::vector<Part>& parts) const {
        tree.nodes_.push_back(empty_node());
        for (int b = 0; b < count; ++b) {
            const auto& child = children[static_cast<std::size_t>(b)];
            if (child.is_leaf()) {
                tree.nodes_[0].child[b] = append_leaf(tree, child);
                continue;
            }
            const auto branch_node = static_cast<std::uint32_t>(tree.nodes_.size());
            tree.nodes_[0].child[b] = branch_node;
            tree.nodes_.push_back(empty_node());
            const auto& branch = branches[static_cast<std::size_t>(b)];
            for (int i = 0; i < branch.count; ++i) {
                const auto& range = branch.children[static_cast<std::size_t>(i)];
                tree.nodes_[branch_node].child[i] =
                    range.is_leaf() ? append_leaf(tree, range)
                                    : append(tree, parts[static_cast<std::size_t>(b * node_width + i)],
                                             static_cast<std::uint32_t>(tree.nodes_.size()));
            }
        }
    }

    std::uint32_t append_leaf(TriangleTree& tree, const Range& range) const {
        Part leaf;
        add_pack(range, leaf);
        const auto index = static_cast<std::uint32_t>(tree.labels_.size());
        append_pack(tree, leaf.packs[0]);
        return index | BoxNode::leaf_bit;
    }

    static std::uint32_t append(TriangleTree& tree, const Part& part, std::uint32_t first_node) {
        const auto first_pack = static_cast<std::uint32_t>(tree.labels_.size());
        for (BoxNode node : part.nodes) {
            for (std::uint32_t& child : node.child) {
                if (child == BoxNode::unused) {
                    continue;
                }
                child += child & BoxNode::leaf_bit ? first_pack : first_node;
            }
            tree.nodes_.push_back(node);
        }
        for (const auto& ids : part.packs) {
            append_pack(tree, ids);
        }
        return first_node;
    }

    static void append_pack(TriangleTree& tree, const std::array<std::uint32_t, lane_count>& ids) {
        std::ranges::copy(ids, tree.labels_.emplace_back().triangle);
    }

    const TriangleMesh& mesh_;
    const ParallelRunner& run_;
    const ParallelRunner serial_ = run_serially;
    Vec3 origin_{0.0};
    std::unique_ptr<Primitive[]> primitives_;
};

void TriangleTree::place_features(const TriangleMesh& mesh, const ParallelRunner& run) {
    const std::vector<TriangleFeatures> features = find_features(mesh, run);
    std::vector<std::uint32_t> slot_of(features.size());
    run_in_parts(run, labels_.size(), chunk, [&](std::size_t, std::size_t p, std::size_t end) {
        for (; p < end; ++p) {
            for (std::size_t i = lane_count; i-- > 0;) {  // of the lanes that repeat one, the first
                slot_of[labels_[p].triangle[i]] = static_cast<std::uint32_t>(p * lane_count + i);
            }
        }
    });
    run_in_parts(run, labels_.size(), chunk, [&](std::size_t, std::size_t p, std::size_t end) {
        for (; p < end; ++p) {
            for (std::size_t i = 0; i < lane_count; ++i) {
                const TriangleFeatures& triangle = features[labels_[p].triangle[i]];
                labels_[p].owned[i] = triangle.owned;
                for (std::size_t k = 0; k < 3; ++k) {
                    const EdgeLink other = triangle.neighbour[k];
                    labels_[p].neighbour[k][i] =
                        other.exists()
                            ? EdgeLink::to(slot_of[other.triangle()], static_cast<unsigned>(other.edge()))
                            : other;
                }
            }
        }
    });
}

TriangleTree TriangleTree::build(const TriangleMesh& mesh, const ParallelRunner& run) {
    static std::atomic<std::uint64_t> last_lineage{0};
    TriangleTree tree = TriangleTreeBuilder(mesh, run).build();
    tree.lineage_ = ++last_lineage;
    return tree;
}

}  // namespace tactus
