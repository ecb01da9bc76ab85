// The slabs of the triangle tree: see slab_node.hpp. Of what holds more packs than `max_packs` a slab would
// be no better than the box: such a piece of surface is bent or folded.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/geometry/triangle_tree.hpp"

namespace tactus {

namespace {

constexpr std::size_t max_packs = 4096;
constexpr std::size_t nodes_a_task = 2048;

// Twice the area of the triangles, along their normals.
Vec3 area_of(const TrianglePack& t) {
    const LanesVec3 across = cross(t.b - t.a, t.c - t.a);
    const auto sum = [](const Lanes& lanes) { return lanes[0] + lanes[1] + lanes[2] + lanes[3]; };
    return {sum(across.x), sum(across.y), sum(across.z)};
}

struct Span {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
};

void grow(Span& span, const TrianglePack& t, const LanesVec3& normal, const LanesVec3& origin) {
    for (const LanesVec3& corners : {t.a, t.b, t.c}) {
        const Lanes at = dot(normal, corners - origin);
        span.low = std::min(span.low, smallest(at));
        span.high = std::max(span.high, -smallest(-at));
    }
}

}  // namespace

// The packs below a child, as far as there are no more than fit.
std::size_t TriangleTree::packs_below(std::uint32_t child, std::span<std::uint32_t> out) const {
    if (child & BoxNode::leaf_bit) {
        out[0] = child & ~BoxNode::leaf_bit;
        return 1;
    }
    std::size_t count = 0;
    for (const std::uint32_t below : nodes_[child].child) {
        if (below == BoxNode::unused) {
            continue;
        }
        if (count == out.size()) {
            return out.size() + 1;
        }
        count += packs_below(below, out.subspan(count));
        if (count > out.size()) {
            return count;
        }
    }
    return count;
}

void TriangleTree::fit_slabs(const ParallelRunner& run) {
    slabs_.resize(nodes_.size());
    const LanesVec3 origin = splat(origin_);
    run_in_parts(run, nodes_.size(), nodes_a_task, [&](std::size_t, std::size_t n, std::size_t end) {
        std::vector<std::uint32_t> below(max_packs);
        for (; n < end; ++n) {
            SlabNode& slabs = slabs_[n];
            for (int i = 0; i < node_width; ++i) {
                const std::uint32_t child = nodes_[n].child[i];
                const std::size_t count = child == BoxNode::unused ? 0 : packs_below(child, below);
                Vec3 area(0.0);
                for (std::size_t p = 0; p < count && count <= max_packs; ++p) {
                    area += area_of(pack(below[p]));
                }
                // Shortened, so that the float normal is no longer than 1.
                const double length = glm::length(area) * (1.0 + 1e-6);
                const glm::vec3 normal(length > 0.0 && std::isfinite(length) ? area / length : Vec3(0.0));
                const LanesVec3 along = splat(Vec3(normal));
                Span span;
                for (std::size_t p = 0; p < count && count <= max_packs; ++p) {
                    grow(span, pack(below[p]), along, origin);
                }
                const bool has_slab = span.low <= span.high;
                for (int axis = 0; axis < 3; ++axis) {
                    slabs.normal[axis][i] = has_slab ? normal[axis] : 0.0f;
                }
                slabs.low[i] = has_slab ? round_down(span.low) : 0.0f;
                slabs.high[i] = has_slab ? round_up(span.high) : 0.0f;
            }
        }
    });
}

}  // namespace tactus
