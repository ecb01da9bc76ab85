// How the builder of the tree divides triangles: cells of a grid for large ranges, binned surface-area
// heuristic for middle ones, medians that fill packs for small ones.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "core/math/lanes.hpp"
#include "core/tree/box_node.hpp"

namespace tactus {

using Float4 = float __attribute__((vector_size(16)));

constexpr float infinite = std::numeric_limits<float>::infinity();

inline Float4 lower(Float4 a, Float4 b) {
    return a < b ? a : b;
}
inline Float4 upper(Float4 a, Float4 b) {
    return a > b ? a : b;
}

struct Box {
    Float4 low{infinite, infinite, infinite, 0.0f};
    Float4 high{-infinite, -infinite, -infinite, 0.0f};

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
    Box bounds;              // of the triangles
    Box centers;             // of their doubled centres
    std::uint32_t cell = 0;  // the node of the tree of cells that it is; 0: none

    std::size_t size() const { return end - begin; }
    bool is_leaf() const { return size() <= lane_count; }
    void take(const Primitive& primitive) {
        bounds.grow(primitive.bounds());
        centers.grow(primitive.doubled_center());
    }
    void take(const Range& part) {
        bounds.grow(part.bounds);
        centers.grow(part.centers);
    }
};

// What the leaves of one node hold.
constexpr std::size_t node_full = std::size_t{lane_count} * node_width;

class TreeSplitter {
public:
    // Below this depth only medians halve: what is left is divided evenly, which bounds the depth of the
    // tree.
    static constexpr int heuristic_levels = 8;

    // `cells` is the tree of cells that the primitives are sorted by: node 1 is the whole, those of node i
    // are 2 i and 2 i + 1. Empty: they are not.
    TreeSplitter(Primitive* primitives, std::span<const Range> cells)
        : primitives_(primitives), cells_(cells) {}

    // Of a range of more than lane_count triangles, for a node at this depth: neither half is empty.
    void split(const Range& range, int level, Range& left, Range& right) const;

private:
    bool split_cells(const Range& range, Range& left, Range& right) const;
    bool split_in_the_middle(const Range& range, Range& left, Range& right) const;
    void split_at_median(const Range& range, Range& left, Range& right) const;
    void move_lower_ahead(const Range& range, int axis, std::size_t lower) const;
    template <class GoesLeft>
    std::size_t partition(const Range& range, GoesLeft&& goes_left, Range& left, Range& right) const;

    Primitive* primitives_;
    std::span<const Range> cells_;
};

}  // namespace tactus
