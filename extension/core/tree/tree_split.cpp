#include "core/tree/tree_split.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace tactus {

namespace {

constexpr int bin_count = 16;
constexpr std::size_t median_below = 64;  // at or below, medians that fill packs and nodes beat the heuristic
constexpr std::size_t halves_above = 512;

struct Bins {
    std::array<std::array<Box, bin_count>, 3> box;
    std::array<std::array<std::uint32_t, bin_count>, 3> count{};
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
    float cost = infinite;
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

Bins fill_bins(const BinScale& scale, std::span<const Primitive> primitives) {
    Bins bins;
    for (const Primitive& primitive : primitives) {
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

}  // namespace

// A stable order is not needed, a repeatable one is: this is a plain function of its input.
template <class GoesLeft>
std::size_t TreeSplitter::partition(const Range& range, GoesLeft&& goes_left, Range& left,
                                    Range& right) const {
    left = right = Range{};
    Primitive* low = primitives_ + range.begin;
    Primitive* high = primitives_ + range.end;
    while (low < high) {
        if (goes_left(low->doubled_center())) {
            left.take(*low++);
            continue;
        }
        right.take(*low);
        std::swap(*low, *--high);
    }
    const auto border = static_cast<std::size_t>(low - primitives_);
    left.begin = range.begin;
    left.end = right.begin = border;
    right.end = range.end;
    return border;
}

// The `lower` triangles of a small range with the lowest centres along an axis come first; all keep their
// order. Each is ranked by counting those below it, eight at once: nothing here depends on a guess about the
// order.
void TreeSplitter::move_lower_ahead(const Range& range, int axis, std::size_t lower) const {
    constexpr std::size_t rows = median_below / node_width;
    static_assert(median_below == 64, "a bit for each triangle");
    const std::size_t count = range.size();
    Primitive* const triangles = primitives_ + range.begin;
    FloatLanes centers[rows];
    std::fill(std::begin(centers), std::end(centers), splat_float(infinite));
    for (std::size_t i = 0; i < count; ++i) {
        centers[i / node_width][i % node_width] = triangles[i].doubled_center()[axis];
    }
    const std::size_t used_rows = (count + node_width - 1) / node_width;
    Primitive upper[median_below];
    std::size_t kept = 0;
    std::size_t moved = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const FloatLanes own = splat_float(centers[i / node_width][i % node_width]);
        std::uint64_t below = 0;
        std::uint64_t equal = 0;
        for (std::size_t row = 0; row < used_rows; ++row) {
            below |= std::uint64_t{lane_bits(centers[row] < own)} << (row * node_width);
            equal |= std::uint64_t{lane_bits(centers[row] == own)} << (row * node_width);
        }
        const std::uint64_t ahead = below | (equal & ((std::uint64_t{1} << i) - 1));
        const bool is_lower = static_cast<std::size_t>(std::popcount(ahead)) < lower;
        (is_lower ? triangles[kept] : upper[moved]) = triangles[i];
        kept += is_lower;
        moved += !is_lower;
    }
    std::copy(upper, upper + moved, triangles + kept);
}

// Halves along the longest side, with a whole number of full nodes or packs on the left.
void TreeSplitter::split_at_median(const Range& range, Range& left, Range& right) const {
    const int axis = longest_axis(range.centers.high - range.centers.low);
    const std::size_t unit = range.size() > node_full ? node_full : lane_count;
    const std::size_t units = (range.size() + unit - 1) / unit;
    const std::size_t middle = range.begin + (units / 2) * unit;
    if (range.size() <= median_below) {
        move_lower_ahead(range, axis, middle - range.begin);
    } else {
        std::nth_element(primitives_ + range.begin, primitives_ + middle, primitives_ + range.end,
                         [axis](const Primitive& p, const Primitive& q) {
                             const float a = p.doubled_center()[axis];
                             const float b = q.doubled_center()[axis];
                             return a < b || (a == b && p.id() < q.id());
                         });
    }
    left = {range.begin, middle, {}, {}};
    right = {middle, range.end, {}, {}};
    for (std::size_t i = range.begin; i < range.end; ++i) {
        (i < middle ? left : right).take(primitives_[i]);
    }
}

// Halves the space of the centres along its longest side: where triangles are spread evenly the heuristic
// comes to the same, at twice the cost. False where they are not.
bool TreeSplitter::split_in_the_middle(const Range& range, Range& left, Range& right) const {
    const Float4 size = range.centers.high - range.centers.low;
    const int axis = longest_axis(size);
    const float middle = range.centers.low[axis] + 0.5f * size[axis];
    const std::size_t border =
        partition(range, [&](Float4 center) { return center[axis] < middle; }, left, right);
    return std::min(border - range.begin, range.end - border) >= range.size() / 8;
}

// Nothing is moved: the triangles are in the order of their cells. False for one cell.
bool TreeSplitter::split_cells(const Range& range, Range& left, Range& right) const {
    std::size_t cell = range.cell;
    while (cell != 0 && 2 * cell < cells_.size()) {
        left = cells_[2 * cell];
        right = cells_[2 * cell + 1];
        if (left.size() > 0 && right.size() > 0) {
            return true;
        }
        cell = left.size() > 0 ? left.cell : right.cell;
    }
    return false;
}

void TreeSplitter::split(const Range& range, int level, Range& left, Range& right) const {
    if (range.size() <= median_below || level >= heuristic_levels) {
        split_at_median(range, left, right);
        return;
    }
    if (range.size() > halves_above &&
        (split_cells(range, left, right) || split_in_the_middle(range, left, right))) {
        return;
    }
    const BinScale scale(range.centers);
    const Split best = best_split(fill_bins(scale, {primitives_ + range.begin, range.size()}));
    if (best.axis < 0) {  // all centres in one bin
        split_at_median(range, left, right);
        return;
    }
    partition(
        range, [&](Float4 center) { return scale.bins_of(center)[best.axis] <= best.bin; }, left, right);
}

}  // namespace tactus
