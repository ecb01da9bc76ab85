#include "world/same_shapes.hpp"

#include <algorithm>
#include <type_traits>

namespace tactus {

namespace {

bool same(const std::shared_ptr<const TriangleMesh>& a, const std::shared_ptr<const TriangleMesh>& b) {
    return a == b || (a->vertices == b->vertices && a->triangles == b->triangles);
}
bool same(const SphereShape& a, const SphereShape& b) {
    return a.radius == b.radius;
}
bool same(const BoxShape& a, const BoxShape& b) {
    return a.half_extents == b.half_extents;
}
bool same(const CapsuleShape& a, const CapsuleShape& b) {
    return a.radius == b.radius && a.half_segment == b.half_segment;
}
bool same(const CylinderShape& a, const CylinderShape& b) {
    return a.radius == b.radius && a.half_height == b.half_height;
}
bool same(const PlaneShape& a, const PlaneShape& b) {
    return a.normal == b.normal && a.offset == b.offset;
}
bool same(const ConvexHullShape& a, const ConvexHullShape& b) {
    return same(a.hull, b.hull);
}
bool same(const MeshShape& a, const MeshShape& b) {
    return a.smooth_below == b.smooth_below && a.one_sided == b.one_sided && a.surfaces == b.surfaces &&
           same(a.mesh, b.mesh);
}
bool same(const HeightFieldShape& a, const HeightFieldShape& b) {
    return a.columns == b.columns && a.rows == b.rows && a.scale == b.scale && *a.heights == *b.heights;
}

bool same_shape(const Shape& a, const Shape& b) {
    return std::visit(
        [](const auto& left, const auto& right) {
            if constexpr (std::is_same_v<decltype(left), decltype(right)>) {
                return same(left, right);
            } else {
                return false;
            }
        },
        a, b);
}

}  // namespace

bool same_pose(const Pose& a, const Pose& b) {
    return a.position == b.position && a.rotation == b.rotation;
}

bool same_shapes(const std::vector<PlacedShape>& a, const std::vector<PlacedShape>& b) {
    return std::ranges::equal(a, b, [](const PlacedShape& left, const PlacedShape& right) {
        return same_pose(left.pose, right.pose) && same_shape(left.shape, right.shape);
    });
}

}  // namespace tactus
