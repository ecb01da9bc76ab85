// A tree over the triangles of one mesh, built for the proxy: eight boxes a node, four triangles a leaf, laid
// out for vector instructions. Immutable once built and free of pointers to elsewhere: any number of bodies
// and threads share one tree.
//
// All points and distances are in the mesh's own frame, in metres. Queries allocate nothing.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry/box_node.hpp"
#include "core/geometry/inside_test.hpp"
#include "core/geometry/pack_labels.hpp"
#include "core/geometry/parallel.hpp"
#include "core/geometry/triangle_mesh.hpp"
#include "core/geometry/triangle_pack.hpp"

namespace tactus {

// A pack whose box is near a point. Its triangles are no nearer than `distance` (unit: meters).
struct FoundPack {
    std::uint32_t pack;
    float distance;
};

struct FoundPacks {
    std::size_t count = 0;  // packs written
    bool complete = true;   // false: there were more than fit
};

struct NearestTriangle {
    double distance = 0.0;   // `far` where nothing is nearer (unit: meters)
    std::uint32_t pack = 0;  // the pack that holds it; meaningless where nothing is nearer
};

// What a query may still look at, in packs and nodes: it ends early, on the safe side, where this reaches
// zero.
using Work = std::int64_t;

class TriangleTree {
public:
    // The mesh must be sound (see check_mesh in mesh_check.hpp). The result does not depend on the runner.
    static TriangleTree build(const TriangleMesh& mesh, const ParallelRunner& run = run_serially);

    // Moves the boxes and triangles to new corner positions of the same triangles, O(n), keeping the tree's
    // shape.
    void refit(const TriangleMesh& moved, const ParallelRunner& run = run_serially);
    // The same as another tree: this one may be touched meanwhile.
    TriangleTree refitted(const TriangleMesh& moved, const ParallelRunner& run = run_serially) const;
    // True where both hold the same triangles at the same places of the tree, one as it is refitted.
    bool is_refit_of(const TriangleTree& other) const { return lineage_ == other.lineage_; }

    // Every pack with a triangle in the ball around `center`, by its box: cheap, and with some that have
    // none. Their distances are those from `point`.
    FoundPacks packs_within(const Vec3& center, double radius, const Vec3& point,
                            std::span<FoundPack> out) const;
    FoundPacks packs_within(const Vec3& point, double reach, std::span<FoundPack> out) const {
        return packs_within(point, reach, point, out);
    }

    // The nearest triangle, looked for up to the distance `far`.
    NearestTriangle nearest(const Vec3& point, double far) const;

    // A lower bound of the distance to the nearest triangle, at least half of it. Cheap from anywhere, where
    // `nearest` must look at every triangle from the centre of a ball.
    double least_distance(const Vec3& point) const;

    // The earliest t in [0, limit] at which start + t * motion comes within `distance` (+ slack) of a
    // triangle; above `limit` where it does not. See sweep_to_triangles. Where `work` is used up, the answer
    // is a t up to which the way is known to be free.
    double sweep(const Vec3& start, const Vec3& motion, double distance, double slack, double limit,
                 Work& work) const;

    // How often the surface winds around the point: of use for closed meshes only (see is_closed). Costs
    // what a ray costs; nothing is allocated. Where `work` is used up, nothing is known.
    Winding winding(const Vec3& point, Work& work) const;

    const TrianglePack& pack(std::uint32_t index) const { return packs_[index]; }
    void fetch_pack(std::uint32_t index) const { fetch_early(&packs_[index], sizeof(TrianglePack)); }
    // Which triangles of the mesh stand in the lanes of a pack.
    std::span<const std::uint32_t, lane_count> triangle_ids(std::uint32_t pack) const {
        return labels_[pack].triangle;
    }

    // What is known of the triangles of a pack, the links between them as slots.
    const PackLabels& labels(std::uint32_t pack) const { return labels_[pack]; }

    std::size_t pack_count() const { return labels_.size(); }
    std::size_t triangle_count() const { return triangle_count_; }
    std::size_t bytes() const;
    Vec3 center() const { return origin_; }
    double radius() const { return radius_; }  // of the ball around center() that holds every triangle
    // Largest coordinate in use (unit: meters): what rounding errors scale with.
    double magnitude() const { return magnitude_; }

private:
    double float_slack(const Vec3& relative) const;
    bool crossings(const Vec3& point, int axis, double sign, Work& work, int& number) const;
    NearestTriangle search(const Vec3& point, double far, double share, double& least) const;
    void place_features(const TriangleMesh& mesh, const ParallelRunner& run);
    void place_triangles(const TriangleMesh& mesh, const ParallelRunner& run);
    void forget_sides(const ParallelRunner& run);
    void fit_boxes(const ParallelRunner& run);
    std::uint32_t triangle_at(std::uint32_t slot) const {
        return labels_[slot / lane_count].triangle[slot % lane_count];
    }

    std::vector<BoxNode> nodes_;             // parents before children
    std::unique_ptr<TrianglePack[]> packs_;  // as many as labels_
    std::vector<PackLabels> labels_;
    Vec3 origin_{0.0};
    double radius_ = 0.0;
    double extent_ = 0.0;  // largest distance of a box side from the origin along an axis
    double magnitude_ = 0.0;
    std::size_t triangle_count_ = 0;
    std::uint64_t lineage_ = 0;  // another one for each build

    friend class DeformSweep;
    friend class TriangleTreeBuilder;
};

}  // namespace tactus
