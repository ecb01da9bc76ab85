#include "core/haptics/near_triangles.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

void NearTriangles::add(const TriangleTree& tree, std::uint32_t pack, int lane_index, const Vec3& center) {
    const std::uint32_t id = tree.triangle_ids(pack)[static_cast<std::size_t>(lane_index)];
    for (int i = 0; i < count_; ++i) {
        if (item(i).id == id) {
            return;  // the repeated last triangle of a pack
        }
    }
    if (count_ == capacity) {
        return;
    }
    const TrianglePack& triangles = tree.pack(pack);
    Item& added = items_[static_cast<std::size_t>(count_++)];
    added.a = lane(triangles.a, lane_index);
    added.b = lane(triangles.b, lane_index);
    added.c = lane(triangles.c, lane_index);
    added.closest = closest_point_on_triangle(center, added.a, added.b, added.c);
    added.offset = center - added.closest.point;
    added.distance = glm::length(added.offset);
    added.id = id;
}

bool NearTriangles::is_covered(int index, double same) const {
    const Item& candidate = item(index);
    if (candidate.closest.feature == TriangleFeature::face) {
        return false;
    }
    const double on_it = 16.0 * same;
    for (int i = 0; i < count_; ++i) {
        const Item& other = item(i);
        const bool nearer = other.distance < candidate.distance - same;
        const bool equal = other.distance <= candidate.distance + same;
        const bool stands_first = other.closest.feature == TriangleFeature::face || i < index;
        if (i == index || !(nearer || (equal && stands_first))) {
            continue;
        }
        const Vec3& point = candidate.closest.point;
        const Vec3 gap = closest_point_on_triangle(point, other.a, other.b, other.c).point - point;
        if (glm::dot(gap, gap) <= on_it * on_it) {
            return true;
        }
    }
    return false;
}

Contact NearTriangles::contact(int index, const ScenePart& part, double rest) const {
    const Item& near = item(index);
    Contact contact;
    const Vec3 normal = near.distance > 0.0 ? near.offset / near.distance : Vec3(0.0, 1.0, 0.0);
    const double bend = near.distance > 0.0 ? 1.0 / near.distance : 0.0;
    Vec3 u = std::abs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    u = glm::normalize(glm::cross(normal, u));
    if (near.closest.feature == TriangleFeature::edge) {
        // Normal and edge are perpendicular but for rounding; only a sphere of no size at all has neither.
        const Vec3 across = glm::cross(normal, near.closest.edge_direction);
        const double length = glm::length(across);
        u = length > 0.5 ? across / length : u;
        contact.bend_u = bend;
    } else if (near.closest.feature == TriangleFeature::corner) {
        contact.bend_u = contact.bend_v = bend;
    }
    contact.point = to_parent(part.pose, near.closest.point);
    contact.pivot = contact.point;  // an edge or a corner is the centre of its own curvature
    contact.normal = direction_to_parent(part.pose, normal);
    contact.force_direction = contact.normal;
    if (part.part->smooth_normals) {
        const Vec3 smooth = interpolated_normal((*part.part->smooth_normals)[near.id], near.a, near.b, near.c,
                                                near.closest.point, normal);
        contact.force_direction = direction_to_parent(part.pose, smooth);
    }
    contact.u = direction_to_parent(part.pose, u);
    contact.gap = near.distance - rest;
    contact.body = static_cast<int>(part.body);
    return contact;
}

}  // namespace tactus
