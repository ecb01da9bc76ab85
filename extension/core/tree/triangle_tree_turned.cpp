// The turned boxes of the triangle tree: see turned_node.hpp. What holds more packs than `max_packs` is bent
// or folded: no plane fits it.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

constexpr std::size_t max_packs = 4096;
constexpr std::size_t nodes_a_turn_task = 2048;

double sum_of(const Lanes& lanes) {
    return lanes[0] + lanes[1] + lanes[2] + lanes[3];
}

// Twice the area of the triangles, along their normals.
Vec3 area_of(const TrianglePack& t) {
    const LanesVec3 across = cross(t.b - t.a, t.c - t.a);
    return {sum_of(across.x), sum_of(across.y), sum_of(across.z)};
}

// A turned box as it grows around triangles; in the frame of the mesh.
struct TurnedBox {
    Vec3 middle;
    Vec3 normal, along, third;  // no longer than 1
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    double length = 0.0, width = 0.0;

    void take(const TrianglePack& t) {
        for (const LanesVec3& corners : {t.a, t.b, t.c}) {
            const LanesVec3 offset = corners - splat(middle);
            const Lanes up = dot(splat(normal), offset);
            const Lanes ahead = dot(splat(along), offset);
            const Lanes aside = dot(splat(third), offset);
            low = std::min(low, smallest(up));
            high = std::max(high, -smallest(-up));
            length = std::max(length, -smallest(lanes_min(ahead, -ahead)));
            width = std::max(width, -smallest(lanes_min(aside, -aside)));
        }
    }
    void put(TurnedNode& turned, int slot, float unit) const {
        const double more = turned_margin * (length + width + (high - low));
        turned.low[slot] = round_down(low - more);
        turned.high[slot] = round_up(high + more);
        turned.length[slot] = share_up(length + more, unit);
        turned.width[slot] = share_up(width + more, unit);
    }
};

// The axes of a child's box, as they are stored: across the surface, and about along it.
void set_axes(TurnedNode& turned, int slot, const Vec3& normal, const Vec3& along) {
    const glm::vec3 shortened(normal * (1.0 - 2e-7));
    turned.normal.x[slot] = shortened.x;
    turned.normal.y[slot] = shortened.y;
    turned.normal.z[slot] = shortened.z;
    for (int axis = 0; axis < 3; ++axis) {
        turned.along[axis][slot] = static_cast<std::int16_t>(std::lround(32'766.0 * along[axis]));
    }
}

Vec3 lane(const FloatPoint& v, int slot) {
    return {v.x[slot], v.y[slot], v.z[slot]};
}

// The way in the plane across `normal` along which corners are farthest from the middle, by the sum of their
// squares.
class Spread {
public:
    Spread(const Vec3& normal, const Vec3& middle) : middle_(splat(middle)) {
        const Vec3 other = std::abs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
        u_ = glm::normalize(glm::cross(normal, other));
        v_ = glm::cross(normal, u_);
    }
    void take(const TrianglePack& t) {
        for (const LanesVec3& corners : {t.a, t.b, t.c}) {
            const LanesVec3 offset = corners - middle_;
            const Lanes u = dot(splat(u_), offset);
            const Lanes v = dot(splat(v_), offset);
            difference_ = difference_ + (u * u - v * v);
            product_ = product_ + u * v;
        }
    }
    Vec3 longest() const {
        const double angle = 0.5 * std::atan2(2.0 * sum_of(product_), sum_of(difference_));
        return std::cos(angle) * u_ + std::sin(angle) * v_;
    }

private:
    LanesVec3 middle_;
    Vec3 u_, v_;
    Lanes difference_ = splat(0.0), product_ = splat(0.0);
};

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

// `middle`: of the child's box, in the frame of the mesh; `unit`: its share_unit. Left as it is where no
// plane fits the packs.
void TriangleTree::fit_turned_box(TurnedNode& turned, int slot, const Vec3& middle, float unit,
                                  std::span<const std::uint32_t> packs) const {
    TrianglePack room;
    Vec3 area(0.0);
    for (const std::uint32_t p : packs) {
        area += area_of(pack(p, room));
    }
    if (const double size = glm::length(area); !(size > 0.0 && std::isfinite(size))) {
        return;
    }
    const Vec3 normal = glm::normalize(area);
    Spread spread(normal, middle);
    for (const std::uint32_t p : packs) {
        spread.take(pack(p, room));
    }
    set_axes(turned, slot, normal, spread.longest());
    const TurnedAxes axes = axes_of(turned);
    TurnedBox box;
    box.middle = middle;
    box.normal = lane(turned.normal, slot);
    box.along = lane(axes.along, slot);
    box.third = lane(axes.third, slot);
    for (const std::uint32_t p : packs) {
        box.take(pack(p, room));
    }
    box.put(turned, slot, unit);
}

void TriangleTree::fit_turned_boxes(const ParallelRunner& run) {
    turned_.assign(nodes_.size(), TurnedNode{});
    run_in_parts(run, nodes_.size(), nodes_a_turn_task, [&](std::size_t, std::size_t n, std::size_t end) {
        std::vector<std::uint32_t> room(max_packs);
        for (; n < end; ++n) {
            const FloatPoint middles = middle_of(nodes_[n]);
            const FloatLanes units = share_unit(nodes_[n]);
            for (int i = 0; i < node_width; ++i) {
                const std::uint32_t child = nodes_[n].child[i];
                const std::size_t count = child == BoxNode::unused ? 0 : packs_below(child, room);
                if (count > 0 && count <= max_packs) {
                    fit_turned_box(turned_[n], i, origin_ + lane(middles, i), units[i], {room.data(), count});
                }
            }
        }
    });
}

}  // namespace tactus
