// A tree over the triangles of one mesh, built for the proxy: eight boxes a node, four triangles a leaf, laid
// out for vector instructions. Immutable once built and free of pointers to elsewhere: any number of bodies
// and threads share one tree.
//
// All points and distances are in the mesh's own frame, in metres. Queries allocate nothing.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "core/tree/pack_store.hpp"
#include "core/tree/parallel.hpp"
#include "core/tree/triangle_pack.hpp"
#include "core/tree/turned_node.hpp"
#include "core/tree/visit_queue.hpp"
#include "core/tree/winding.hpp"
#include "core/tree/work.hpp"

namespace tactus {

// A pack whose box is near a point. Its triangles lie behind the plane across `normal` that is `distance`
// before the point.
struct FoundPack {
    std::uint32_t pack;
    float distance;   // (unit: meters)
    float normal[3];  // to the point, no longer than 1; all to 1e-6
};

// The square of a length as the boxes compare it, and a little more; at most the largest float, so that no
// limit ever takes in the infinite distance of unused slots.
inline float square_up(double value) {
    const double squared = value * value * (1.0 + 1e-6);
    return static_cast<float>(std::min(squared, 3.4e38));
}

// Of the mesh, those of one pack. Lanes that fill up a pack repeat its last triangle.
using PackIds = std::array<std::uint32_t, lane_count>;

struct FoundPacks {
    std::size_t count = 0;  // packs written
    double radius = 0.0;    // every pack that is nearer than this is among them (unit: meters)
};

struct NearestTriangle {
    double distance = 0.0;   // `far` where nothing is nearer (unit: meters)
    std::uint32_t pack = 0;  // the pack that holds it; meaningless where nothing is nearer
    bool complete = true;    // false: the budget was gone before everything nearer was looked at
};

// How far a sweep has come that takes longer than a tick has.
struct SweepProgress {
    static constexpr std::size_t max_levels = 32;  // of a tree: from the ninth on each leaves an eighth

    Hit hit;  // of the packs so far
    // Child by child to the pack whose turn it is.
    std::array<std::uint8_t, max_levels> path{};
};

// Where the corners of a mesh's triangles are, and whether single precision holds them exactly.
struct CornerExtent {
    Vec3 low{std::numeric_limits<double>::infinity()};
    Vec3 high{-std::numeric_limits<double>::infinity()};
    bool is_single = true;
};

CornerExtent corner_extent(const TriangleMesh& mesh, const ParallelRunner& run);

class TriangleTree {
public:
    // The mesh must be sound (see check_mesh in mesh_check.hpp). The result does not depend on the runner.
    static TriangleTree build(const TriangleMesh& mesh, const ParallelRunner& run = run_serially);

    // Moves the boxes and triangles to new corner positions of the same triangles, O(n), keeping the tree's
    // shape.
    void refit(const TriangleMesh& moved, const ParallelRunner& run = run_serially);
    // The same as another tree: this one may be touched meanwhile.
    TriangleTree refitted(const TriangleMesh& moved, const ParallelRunner& run = run_serially) const;
    // The same for a mesh that deforms in every tick: from the second call on nothing is allocated. Its boxes
    // lie along the axes alone, the work is a third of a refit's.
    void follow(const TriangleMesh& moved);
    // True where both hold the same triangles at the same places of the tree, one as it is refitted.
    bool is_refit_of(const TriangleTree& other) const { return lineage_ == other.lineage_; }
    // The same number for those: another one for each build in this process, never 0.
    std::uint64_t lineage() const { return lineage_; }

    // The packs around a point by their boxes, nearest nodes first: as many as fit, up to the
    // radius.
    FoundPacks packs_around(const Vec3& point, double radius, WorkBudget& work,
                            std::span<FoundPack> out) const;

    // The nearest triangle, looked for up to the distance `far`. Where the budget ends the search, the answer
    // is not complete: a nearer one may exist. One nearer than `enough` ends it: no nearer one is looked for.
    NearestTriangle nearest(const Vec3& point, double far, WorkBudget& work, double enough = 0.0) const;
    NearestTriangle nearest(const Vec3& point, double far) const;

    // A triangle that is farther than the nearest by a factor of 1 / share at most, where one is nearer than
    // share * far and the answer is complete. Of thousands that are about as near it looks at few.
    NearestTriangle nearly_nearest(const Vec3& point, double far, double share, WorkBudget& work) const;

    // A lower bound of the distance to the nearest triangle, at least half of it. Cheap from anywhere, where
    // `nearest` must look at every triangle from the centre of a ball; lower still where the budget is gone.
    double least_distance(const Vec3& point, WorkBudget& work) const;

    // Calls visit(pack) for packs that may hold a triangle within `limit` of the point, nearest box first;
    // visit may lower `limit`. Returns a lower bound of the distances of all packs that were not visited:
    // below the limit only where the budget was gone, or more nodes were near than can wait.
    template <class Visit>
    double visit_near(const Vec3& point, const double& limit, WorkBudget& work, Visit&& visit) const;

    // The first triangle that stops the sphere at t <= limit. See sweep_to_triangles.
    Hit sweep(const SphereWay& way, double limit, WorkBudget& work) const;
    // The same up to progress.hit.t, pack after pack as they lie in the tree, from where it has come to.
    // False where the budget ends it: asked again, it goes on there.
    bool sweep_on(const SphereWay& way, SweepProgress& progress, WorkBudget& work) const;

    // How often the surface winds around the point: of use for closed meshes only (see is_closed). Costs
    // what a ray costs; nothing is allocated. Where `work` is used up, nothing is known.
    Winding winding(const Vec3& point, WorkBudget& work) const;

    // In `room` only where it is kept in single precision.
    const TrianglePack& pack(std::uint32_t index, TrianglePack& room) const { return packs_.at(index, room); }
    // From the triangles of a pack to one point, or to one for each. See offset_from_triangles.
    [[gnu::always_inline]] PackOffset offset_from_pack(std::uint32_t index, const LanesVec3& point) const {
        TrianglePack room;
        return offset_from_triangles(packs_.at(index, room), point);
    }
    void fetch_pack(std::uint32_t index) const { packs_.fetch(index); }
    // A triangle is known by its slot in the tree: pack * lane_count + lane.
    TriangleCorners corners(std::uint32_t slot) const {
        return packs_.corners(slot / lane_count, slot % lane_count);
    }
    std::uint32_t triangle_at(std::uint32_t slot) const { return ids_[slot / lane_count][slot % lane_count]; }
    // Which triangles of the mesh stand in the lanes of a pack.
    const PackIds& triangle_ids(std::uint32_t pack) const { return ids_[pack]; }

    // triangle_at() gives `names` by the triangles of the mesh from now on.
    void name_triangles(std::span<const std::uint32_t> names) {
        for (PackIds& ids : ids_) {
            std::ranges::transform(ids, ids.begin(), [&](std::uint32_t id) { return names[id]; });
        }
    }

    std::size_t pack_count() const { return ids_.size(); }
    std::size_t triangle_count() const { return triangle_count_; }
    std::size_t bytes() const;
    // What queries read, as it lies in memory: until the next refit.
    std::array<std::span<const std::byte>, 3> memory() const {
        return {std::as_bytes(std::span(nodes_)), std::as_bytes(std::span(turned_)), packs_.memory()};
    }
    Vec3 center() const { return origin_; }
    double radius() const { return radius_; }  // of the ball around center() that holds every triangle
    // Largest coordinate in use (unit: meters): what rounding errors scale with.
    double magnitude() const { return magnitude_; }

private:
    double float_slack(const Vec3& relative) const;
    FloatWay to_float_way(const SphereWay& way, double limit) const;
    void sweep_pack(std::uint32_t pack, const SphereWay& way, Hit& hit, WorkBudget& work) const;
    bool sweep_node(std::uint32_t node, std::size_t level, const SphereWay& way, const FloatWay& boxes,
                    SweepProgress& progress, WorkBudget& work) const;
    double point_rounding(const Vec3& relative) const;
    bool crossings(const Vec3& point, int axis, double sign, WorkBudget& work, int& number) const;
    NearestTriangle search(const Vec3& point, const NearestTriangle& known, double share, double enough,
                           double& least, WorkBudget& work) const;
    std::uint32_t pack_down_nearest_boxes(const Vec3& point, WorkBudget& work) const;
    double distance_to_pack(std::uint32_t pack, const Vec3& point, WorkBudget& work) const;
    // Whether the packs of a node are looked at, or only told: at once, with their place in the node that was
    // asked for its keys last.
    enum class PackUse { look, tell };
    template <PackUse use = PackUse::look, class Keys, class Visit>
    float visit_best_first(const float& limit, WorkBudget& work, Keys&& keys, Visit&& visit) const;
    void place_nodes(const TriangleMesh& mesh, const CornerExtent& extent, const ParallelRunner& run);
    void place_triangles(const TriangleMesh& mesh, bool single, const ParallelRunner& run);
    void place_pack(std::size_t index, const TriangleMesh& mesh);
    void fit_boxes(const ParallelRunner& run);
    // What the triangles below some nodes have been seen to reach.
    struct Extremes {
        double squared_radius = 0.0;
        double magnitude = 0.0;
    };
    Extremes fit_leaves(std::size_t first_node, std::size_t end);
    void fit_inner(const Extremes& all);
    void fit_turned_box(TurnedNode& turned, int slot, const Vec3& middle, float unit,
                        std::span<const std::uint32_t> packs) const;
    void fit_turned_boxes(const ParallelRunner& run);
    std::size_t packs_below(std::uint32_t child, std::span<std::uint32_t> out) const;

    std::vector<BoxNode> nodes_;      // parents before children
    std::vector<TurnedNode> turned_;  // one a node
    PackStore packs_;                 // as many as ids_
    std::vector<PackIds> ids_;
    Vec3 origin_{0.0};
    double radius_ = 0.0;
    double extent_ = 0.0;  // largest distance of a box side from the origin along an axis
    double magnitude_ = 0.0;
    std::size_t triangle_count_ = 0;
    std::uint64_t lineage_ = 0;  // another one for each build

    friend class DeformSweep;
    friend class TreeBoxes;
};

// Opens nodes in the order of their keys, so that whatever the budget leaves over lies beyond everything that
// was seen. Packs that are looked at are asked for early, and take their turn with the nodes: of thousands
// that are met late none is looked at before all that could be met earlier, so that a search that ends early
// knows how far nothing is met. Returns a lower bound of the keys of all packs that were not visited.
template <TriangleTree::PackUse use, class Keys, class Visit>
float TriangleTree::visit_best_first(const float& limit, WorkBudget& work, Keys&& keys, Visit&& visit) const {
    VisitQueue queue;
    queue.push({0.0f, 0});
    FloatLanes beyond = splat_float(__builtin_inff());
    float left_out = __builtin_inff();
    while (!queue.is_empty()) {
        const VisitQueue::Entry entry = queue.pop();
        if (!(entry.key <= limit) || work.is_gone()) {
            left_out = std::min(left_out, entry.key);
            break;
        }
        if constexpr (use == PackUse::look) {
            if (entry.node & BoxNode::leaf_bit) {
                visit(entry.node & ~BoxNode::leaf_bit, entry.key);
                continue;
            }
        }
        work.spend(cost::box_node);
        const BoxNode& node = nodes_[entry.node];
        const FloatLanes key = keys(entry.node);
        const auto within = key <= splat_float(limit);
        beyond = within ? beyond : box_detail::least(beyond, key);
        VisitQueue::Entry packs[node_width];
        int slots[node_width];
        int count = 0;
        for (unsigned bits = lanes_up_to(key, limit); bits != 0; bits &= bits - 1) {
            const int i = std::countr_zero(bits);
            const VisitQueue::Entry child{key[i], node.child[i]};
            if (child.node & BoxNode::leaf_bit) {
                int place = count++;
                if constexpr (use == PackUse::look) {
                    fetch_pack(child.node & ~BoxNode::leaf_bit);
                    for (; place > 0 && child.key < packs[place - 1].key; --place) {
                        packs[place] = packs[place - 1];
                    }
                }
                packs[place] = child;
                slots[place] = i;
            } else {
                fetch_early(&nodes_[child.node], sizeof(BoxNode));
                fetch_early(&turned_[child.node], sizeof(TurnedNode));
                if (!queue.push(child)) {
                    left_out = std::min(left_out, child.key);
                }
            }
        }
        for (int i = 0; i < count; ++i) {
            if (!(packs[i].key <= limit)) {
                left_out = std::min(left_out, packs[i].key);
            } else if (use == PackUse::look && queue.can_wait(packs[i].key)) {
                queue.push(packs[i]);
            } else if constexpr (use == PackUse::tell) {
                visit(packs[i].node & ~BoxNode::leaf_bit, slots[i]);
            } else {
                visit(packs[i].node & ~BoxNode::leaf_bit, packs[i].key);
            }
        }
    }
    for (int i = 0; i < node_width; ++i) {
        left_out = std::min(left_out, beyond[i]);
    }
    return left_out;
}

template <class Visit>
double TriangleTree::visit_near(const Vec3& point, const double& limit, WorkBudget& work,
                                Visit&& visit) const {
    const Vec3 relative = point - origin_;
    const double slack = float_slack(relative);
    const FloatPoint at = to_float_point(relative);
    const auto rounding = static_cast<float>(point_rounding(relative));
    float bound = square_up(limit + slack);
    const float left_out = visit_best_first(
        bound, work,
        [&](std::uint32_t node) { return squared_distance(nodes_[node], turned_[node], at, rounding); },
        [&](std::uint32_t pack, float) {
            visit(pack);
            bound = square_up(limit + slack);
        });
    // What lies beyond the bound is farther than the limit, however little of that the rounding leaves.
    const double least = std::max(0.0, std::sqrt(static_cast<double>(left_out)) * (1.0 - 1e-6) - slack);
    return left_out > bound ? std::max(least, limit) : least;
}

}  // namespace tactus
