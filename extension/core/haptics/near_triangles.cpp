#include "core/haptics/near_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

void NearTriangles::add(const TriangleTree& tree, std::uint32_t pack, int lane_index, const Vec3& center) {
    const std::uint32_t id = tree.triangle_ids(pack)[static_cast<std::size_t>(lane_index)];
    const bool repeated = count_ > 0 && item(count_ - 1).id == id;  // the last triangle fills up a pack
    if (repeated || count_ == capacity) {
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
        // Neighbours mostly have their closest point in common.
        const Vec3& point = candidate.closest.point;
        if (glm::distance(point, other.closest.point) <= on_it ||
            glm::distance(point, closest_point_on_triangle(point, other.a, other.b, other.c).point) <=
                on_it) {
            return true;
        }
    }
    return false;
}

// The direction of the offset is as exact as the coordinates are over the distance. The triangle's own normal
// does not suffer from a small distance far from the origin, but from the triangle being a sliver.
Vec3 NearTriangles::normal_of(const Item& near) {
    if (near.closest.feature == TriangleFeature::face) {
        const Vec3 ab = near.b - near.a;
        const Vec3 ac = near.c - near.a;
        const Vec3 across = glm::cross(ab, ac);
        const double squared = glm::dot(across, across);
        constexpr double sliver = 1e-4;  // sine of its sharpest angle
        if (squared > sliver * sliver * glm::dot(ab, ab) * glm::dot(ac, ac)) {
            return across * (std::copysign(1.0, glm::dot(across, near.offset)) / std::sqrt(squared));
        }
    }
    return near.distance > 0.0 ? near.offset / near.distance : Vec3(0.0, 1.0, 0.0);
}

// An edge ends for a proxy that moves across it where it comes to stand above one of the edge's faces, and a
// corner where it comes to stand beside one of the corner's edges: whichever triangle is first.
void NearTriangles::add_ends(const Item& near, const ScenePart& part, double same, ContactList& out) const {
    const double squared_same = 256.0 * same * same;
    const auto add = [&](const Vec3& direction) {
        const double room = std::max(0.0, -glm::dot(near.offset, direction));
        out.add_end({direction_to_parent(part.pose, direction), room});
    };
    for (int i = 0; i < count_; ++i) {
        const Item& other = item(i);
        const Vec3 apart = other.closest.point - near.closest.point;
        if (glm::dot(apart, apart) > squared_same) {
            continue;
        }
        Vec3 widest(0.0);  // from the edge to the farthest corner
        for (const Vec3& corner : {other.a, other.b, other.c}) {
            const Vec3 way = corner - near.closest.point;
            const double length_squared = glm::dot(way, way);
            if (near.closest.feature == TriangleFeature::edge) {
                const Vec3& along = near.closest.edge_direction;
                const Vec3 off_edge = way - along * glm::dot(along, way);
                widest = glm::dot(off_edge, off_edge) > glm::dot(widest, widest) ? off_edge : widest;
            } else if (length_squared > squared_same) {
                add(way);
            }
        }
        if (near.closest.feature == TriangleFeature::edge) {
            add(widest);
        }
    }
}

void NearTriangles::add_contact(int index, const ScenePart& part, double rest, double same,
                                ContactList& out) const {
    const Item& near = item(index);
    Contact contact;
    const Vec3 normal = normal_of(near);
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
    if (contact.bend_u > 0.0) {
        contact.first_end = out.end_count;
        add_ends(near, part, same, out);
        contact.end_count = out.end_count - contact.first_end;
    }
    contact.point = to_parent(part.pose, near.closest.point);
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
    out.add(contact);
}

}  // namespace tactus
