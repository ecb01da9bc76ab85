// The point of one triangle nearest to a given point, and which part of the triangle it lies on. The scalar
// sibling of offset_from_triangles, for the few triangles that are in contact.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

enum class TriangleFeature : std::uint8_t { face, edge, corner };

struct TriangleClosestPoint {
    Vec3 point{0.0};  // in the frame of the triangle (unit: meters)
    TriangleFeature feature = TriangleFeature::face;
    Vec3 edge_direction{0.0};  // unit vector along the edge where feature is edge
};

// For a triangle without area the feature is an edge or a corner.
TriangleClosestPoint closest_point_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                               const Vec3& c);

}  // namespace tactus
