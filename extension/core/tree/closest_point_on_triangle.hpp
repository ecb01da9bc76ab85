// The point of one triangle nearest to a given point, and which part of the triangle it lies on. The scalar
// sibling of offset_from_triangles, for the few triangles that are in contact.
#pragma once

#include <cstdint>

#include "core/math/types.hpp"

namespace tactus {

enum class TriangleFeature : std::uint8_t { face, edge, corner };

struct TriangleClosestPoint {
    Vec3 point{0.0};  // in the frame of the triangle (unit: meters)
    TriangleFeature feature = TriangleFeature::face;
    std::uint8_t edge = 0;  // where feature is edge: 0 from a to b, 1 from b to c, 2 from c to a
};

// For a triangle without area the feature is an edge or a corner.
TriangleClosestPoint closest_point_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                               const Vec3& c);

// Whether it is inside the triangle, where that is plain: never for one that is slim.
bool is_above_face(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace tactus
