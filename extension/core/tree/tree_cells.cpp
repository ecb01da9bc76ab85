#include "core/tree/tree_cells.hpp"

#include <algorithm>
#include <utility>

namespace tactus {

namespace {

constexpr std::size_t chunk = std::size_t{1} << 16;  // triangles a task looks at

// Bits of a cell's place along one axis: cells of some hundred triangles of a surface, and no more of them
// than a cache holds counts of.
int bits_for(std::size_t triangles) {
    return triangles < (std::size_t{1} << 14) ? 0 : (triangles < (std::size_t{1} << 18) ? 4 : 5);
}

// The bits of three numbers below 32, in turn (Morton's order).
std::uint32_t interleaved(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const auto spread = [](std::uint32_t v) {
        return (v & 1u) | (v & 2u) << 2 | (v & 4u) << 4 | (v & 8u) << 6 | (v & 16u) << 8;
    };
    return spread(x) << 2 | spread(y) << 1 | spread(z);
}

// Cubic cells over the whole mesh.
struct Grid {
    Vec3 low;
    double per_meter;
    std::uint32_t last;

    Grid(const CornerExtent& extent, int bits) : low(extent.low), last((1u << bits) - 1) {
        const Vec3 size = extent.high - extent.low;
        const double longest = std::max({size.x, size.y, size.z, 1e-300});
        per_meter = (last + 1) / longest;
    }
    std::uint32_t cell_of(const Vec3& place) const {
        const Vec3 at = (place - low) * per_meter;
        const auto along = [&](double v) {
            return std::min(static_cast<std::uint32_t>(std::max(v, 0.0)), last);
        };
        return interleaved(along(at.x), along(at.y), along(at.z));
    }
};

Float4 to_float(const Vec3& place) {
    return Float4{static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z),
                  0.0f};
}

}  // namespace

SortedTriangles sort_into_cells(const TriangleMesh& mesh, const CornerExtent& extent, const Vec3& origin,
                                const ParallelRunner& run) {
    const std::size_t count = mesh.triangles.size();
    const int bits = bits_for(count);
    const std::size_t cell_count = std::size_t{1} << (3 * bits);
    const Grid grid(extent, bits);
    std::vector<std::uint16_t> cell_of(count);
    std::vector<std::vector<std::uint32_t>> counts((count + chunk - 1) / chunk);
    run_in_parts(run, count, chunk, [&](std::size_t c, std::size_t t, std::size_t end) {
        counts[c].resize(cell_count);
        for (; t < end; ++t) {
            const auto& [a, b, d] = mesh.triangles[t];
            const Vec3 middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[d]) * (1.0 / 3.0);
            const std::uint32_t cell = grid.cell_of(middle);
            cell_of[t] = static_cast<std::uint16_t>(cell);
            ++counts[c][cell];
        }
    });
    SortedTriangles sorted{std::make_unique_for_overwrite<Primitive[]>(count),
                           std::vector<Range>(2 * cell_count)};
    std::size_t first = 0;
    for (std::size_t cell = 0; cell < cell_count; ++cell) {
        sorted.cells[cell_count + cell].begin = first;
        for (auto& of_chunk : counts) {
            first += std::exchange(of_chunk[cell], static_cast<std::uint32_t>(first));
        }
        sorted.cells[cell_count + cell].end = first;
    }
    run_in_parts(run, count, chunk, [&](std::size_t c, std::size_t t, std::size_t end) {
        for (; t < end; ++t) {
            Box box;
            for (const std::uint32_t corner : mesh.triangles[t]) {
                box.grow(to_float(mesh.vertices[corner] - origin));
            }
            Primitive& primitive = sorted.primitives[counts[c][cell_of[t]]++];
            primitive = {box.low, box.high};
            primitive.set_id(static_cast<std::uint32_t>(t));
        }
    });
    run_in_parts(run, cell_count, 256, [&](std::size_t, std::size_t cell, std::size_t end) {
        for (; cell < end; ++cell) {
            Range& range = sorted.cells[cell_count + cell];
            for (std::size_t i = range.begin; i < range.end; ++i) {
                range.take(sorted.primitives[i]);
            }
        }
    });
    for (std::size_t node = 2 * cell_count; node-- > 1;) {
        Range& range = sorted.cells[node];
        range.cell = static_cast<std::uint32_t>(node);
        if (node < cell_count) {
            const Range& left = sorted.cells[2 * node];
            const Range& right = sorted.cells[2 * node + 1];
            range.begin = left.begin;
            range.end = right.end;
            range.take(left);
            range.take(right);
        }
    }
    return sorted;
}

}  // namespace tactus
