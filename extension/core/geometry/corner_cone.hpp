// Directions in which a sphere can lie at a corner of a mesh.
#pragma once

#include <vector>

#include "core/geometry/empty_ball.hpp"
#include "core/geometry/shared_mesh.hpp"

namespace tactus {

// Directions that rounding may have turned by more are not trusted: what they belong to counts as one that
// can be touched (unit: radians).
constexpr double max_doubt = 1e-6;
constexpr double parallel_sine = 1e-9;  // of directions that are parallel

// The cone of directions that lead away from all edges of a corner: {n : n.e <= 0 for all e}.
class CornerCone {
public:
    CornerCone(const SharedMesh& shared, std::uint32_t vertex);

    // Whether a ball can touch the corner from one of them.
    bool may_touch(EmptyBall& ball);

private:
    void add_perpendicular(const Vec3& e, const Vec3& f);
    void add(const Vec3& ray, double doubt);
    bool may_touch_in_plane(const Vec3& up, EmptyBall& ball);
    bool may_touch_in_cone(EmptyBall& ball);

    Vec3 place_;
    std::vector<Vec3> edges_;  // unit, away from the corner
    std::vector<Vec3> rays_;   // that span the cone, unit
    double rounding_ = 0.0;    // of edges (unit: radians)
    double doubt_ = 0.0;       // of rays (unit: radians)
};

}  // namespace tactus
