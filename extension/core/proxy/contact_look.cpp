#include "core/proxy/contact_look.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/perpendicular.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

// Corners that stand before a plane by this many times `same` are in it: a sixteenth of the skin, of which
// sweeps leave the sphere half.
constexpr double flat = 32.0;

ContactState state_of(TriangleFeature feature) {
    constexpr ContactState states[] = {ContactState::face, ContactState::edge, ContactState::corner};
    return states[static_cast<std::size_t>(feature)];
}

SolidDistance look_at_solid(const ScenePart& part, const Vec3& center, WorkBudget& work) {
    work.spend(cost::solid_look);
    return distance_to_solid(part.part->solid(), to_local(part.pose, center));
}

Vec3 edge_direction(const TriangleCorners& t, int edge) {
    const Vec3 way = edge == 0 ? t.b - t.a : edge == 1 ? t.c - t.b : t.a - t.c;
    return glm::normalize(way);
}

}  // namespace

Contact solid_contact(std::uint32_t part, const Pose& pose, const SolidDistance& at, double rest) {
    return {direction_to_parent(pose, at.normal),
            at.distance - rest,
            {part},
            at.is_flat() ? ContactState::face : ContactState::solid};
}

SurfacePoint ContactLook::at(const FeatureId& feature) const {
    work_.spend(cost::closest_point);
    const ScenePart& part = placed(feature);
    return surface_point(*part.part, feature.triangle, to_local(part.pose, center_));
}

Contact ContactLook::exact_contact(const FeatureId& feature) const {
    const ScenePart& part = placed(feature);
    if (!part.part->tree()) {
        return solid_contact(feature.part, part.pose, look_at_solid(part, center_, work_), rest_);
    }
    const SurfacePoint nearest = at(feature);
    return {direction_to_parent(part.pose, nearest.normal), nearest.distance - rest_, feature,
            state_of(nearest.kind), nearest.edge};
}

bool ContactLook::is_above_face(const Contact& contact) const {
    const ScenePart& part = placed(contact.feature);
    if (!part.part->tree()) {
        // Of the same side the normal is the same to the bit.
        const Contact now = exact_contact(contact.feature);
        return now.state == ContactState::face && now.normal == contact.normal;
    }
    work_.spend(cost::closest_point);
    const TriangleCorners t = part.part->tree()->corners(contact.feature.triangle);
    return tactus::is_above_face(to_local(part.pose, center_), t.a, t.b, t.c);
}

bool ContactLook::look_closely(ContactList& contacts, int index, double step) const {
    Contact& contact = contacts[index];
    const SurfacePoint nearest = at(contact.feature);
    const Vec3 normal = direction_to_parent(placed(contact.feature).pose, nearest.normal);
    const double gap = nearest.distance - rest_;
    const bool differs =
        std::abs(gap - contact.gap) > same_ || glm::distance(normal, contact.normal) * step > same_;
    contact = {normal, gap, contact.feature, state_of(nearest.kind), nearest.edge};
    if (is_covered(contacts, index, nearest)) {
        contact.state = ContactState::covered;
        return true;
    }
    return differs;
}

void ContactLook::cover_behind_nearest(ContactList& contacts) const {
    int nearest = -1;
    for (int i = 0; i < contacts.count; ++i) {
        if (contacts[i].state != ContactState::covered &&
            (nearest < 0 || contacts[i].gap < contacts[nearest].gap)) {
            nearest = i;
        }
    }
    if (nearest < 0 || !placed(contacts[nearest].feature).part->tree()) {
        return;
    }
    Contact& first = contacts[nearest];
    const ScenePart& part = placed(first.feature);
    const SurfacePoint plane = at(first.feature);
    first.normal = direction_to_parent(part.pose, plane.normal);
    first.gap = plane.distance - rest_;
    const double height = glm::dot(plane.normal, plane.point) + flat * same_;
    work_.spend(2 * contacts.count);
    for (int i = 0; i < contacts.count; ++i) {
        Contact& other = contacts[i];
        if ((other.state != ContactState::seen && other.state != ContactState::face) ||
            other.feature.part != first.feature.part || other.gap <= first.gap + same_) {
            continue;
        }
        const TriangleCorners t = part.part->tree()->corners(other.feature.triangle);
        const double highest =
            std::max({glm::dot(plane.normal, t.a), glm::dot(plane.normal, t.b), glm::dot(plane.normal, t.c)});
        other.state = highest <= height ? ContactState::covered : other.state;
    }
}

bool ContactLook::is_covered(ContactList& contacts, int index, const SurfacePoint& candidate) const {
    if (candidate.kind == TriangleFeature::face) {
        return false;
    }
    const Contact contact = contacts[index];
    const ScenePart& part = placed(contact.feature);
    const TriangleTree& tree = *part.part->tree();
    const Vec3 point = to_parent(part.pose, candidate.point);
    const double on_it = same_point * same_;
    // A triangle lies behind its tangent: that tells most of them apart.
    const auto may_contain = [&](const Contact& other) {
        return other.feature.part == contact.feature.part && other.gap <= contact.gap + same_ &&
               glm::dot(other.normal, point - center_) + other.gap + rest_ <= on_it;
    };
    const auto contains = [&](const Contact& other) {
        work_.spend(cost::closest_point);
        // Neighbours mostly have their closest point in common.
        if (glm::distance(center_ - other.normal * (other.gap + rest_), point) <= on_it) {
            return true;
        }
        const TriangleCorners t = tree.corners(other.feature.triangle);
        const Vec3 low = glm::min(glm::min(t.a, t.b), t.c) - on_it;
        const Vec3 high = glm::max(glm::max(t.a, t.b), t.c) + on_it;
        return glm::clamp(candidate.point, low, high) == candidate.point &&
               glm::distance(candidate.point,
                             closest_point_on_triangle(candidate.point, t.a, t.b, t.c).point) <= on_it;
    };
    const auto is_face = [&](const Contact& other) {
        return other.state == ContactState::face ||
               ((other.state == ContactState::seen || other.state == ContactState::covered) &&
                at(other.feature).kind == TriangleFeature::face);
    };
    work_.spend(1 + contacts.count / 8);
    for (int i = 0; i < contacts.count; ++i) {
        Contact& other = contacts[i];
        if (i == index || !may_contain(other) || !contains(other)) {
            continue;
        }
        const bool nearer = other.gap < contact.gap - same_;
        const bool stands_first = !nearer && is_face(other);
        if (stands_first && other.state == ContactState::covered) {
            other.state = ContactState::seen;
        }
        if (nearer || stands_first || i < index) {
            return true;
        }
    }
    return false;
}

bool ContactLook::is_covered_by_any(const Contact& contact) const {
    const SurfacePoint candidate = at(contact.feature);
    if (candidate.kind == TriangleFeature::face) {
        return false;
    }
    const ScenePart& part = placed(contact.feature);
    const TriangleTree& tree = *part.part->tree();
    const LanesVec3 center = splat(to_local(part.pose, center_));
    const LanesVec3 point = splat(candidate.point);
    const double on_it = same_point * same_;
    const double nearer = candidate.distance - same_;
    bool covered = false;
    tree.visit_near(candidate.point, on_it, work_, [&](std::uint32_t pack) {
        work_.spend(2 * cost::pack_look);
        TrianglePack room;
        const TrianglePack& triangles = tree.pack(pack, room);
        const LaneMask containing = offset_from_triangles(triangles, point).squared <= splat(on_it * on_it);
        const LaneMask is_nearer = offset_from_triangles(triangles, center).squared < splat(nearer * nearer);
        covered = covered || any(containing & is_nearer);
    });
    return covered;
}

// An edge ends for a sphere that moves across it where it comes to stand above one of the edge's faces, and a
// corner where it comes to stand beside one of the corner's edges: whichever triangle is first.
void ContactLook::add_ends(const ContactList& contacts, const Contact& contact, Curvature& out) const {
    const ScenePart& part = placed(contact.feature);
    const TriangleTree& tree = *part.part->tree();
    const double distance = contact.gap + rest_;
    const Vec3 point = center_ - contact.normal * distance;
    const Vec3 local_point = to_local(part.pose, point);
    const Vec3 offset = direction_to_local(part.pose, contact.normal) * distance;
    const bool is_edge = contact.state == ContactState::edge;
    const Vec3 along =
        is_edge ? edge_direction(tree.corners(contact.feature.triangle), contact.edge) : Vec3(0.0);
    const double squared_same = same_point * same_point * same_ * same_;
    const auto add = [&](const Vec3& direction) {
        const double room = std::max(0.0, -glm::dot(offset, direction));
        out.add_end({direction_to_parent(part.pose, direction), room});
    };
    for (const Contact& other : contacts.all()) {
        if (other.feature.part != contact.feature.part ||
            std::abs(other.gap - contact.gap) > same_point * same_) {
            continue;
        }
        const Vec3 apart = center_ - other.normal * (other.gap + rest_) - point;
        if (glm::dot(apart, apart) > squared_same) {
            continue;
        }
        const TriangleCorners t = tree.corners(other.feature.triangle);
        Vec3 widest(0.0);  // from the edge to the farthest corner
        for (const Vec3& corner : {t.a, t.b, t.c}) {
            const Vec3 way = corner - local_point;
            if (is_edge) {
                const Vec3 off_edge = way - along * glm::dot(along, way);
                widest = glm::dot(off_edge, off_edge) > glm::dot(widest, widest) ? off_edge : widest;
            } else if (glm::dot(way, way) > squared_same) {
                add(way);
            }
        }
        if (is_edge) {
            add(widest);
        }
    }
}

double ContactLook::max_bend(const Contact& contact) const {
    if (contact.state == ContactState::face) {
        return 0.0;
    }
    if (contact.state != ContactState::solid) {
        return 1.0 / (contact.gap + rest_);
    }
    const SolidDistance at = look_at_solid(placed(contact.feature), center_, work_);
    return std::max(at.bend_u, at.bend_v);
}

Curvature ContactLook::curvature_of(const ContactList& contacts, int index) const {
    const Contact& contact = contacts[index];
    const ScenePart& part = placed(contact.feature);
    Curvature result;
    if (contact.state == ContactState::solid) {
        const SolidDistance solid = look_at_solid(part, center_, work_);
        result.u = direction_to_parent(part.pose, solid.u);
        result.bend_u = solid.bend_u;
        result.bend_v = solid.bend_v;
        for (int i = 0; i < solid.end_count; ++i) {
            const SurfaceEnd& end = solid.ends[static_cast<std::size_t>(i)];
            result.add_end({direction_to_parent(part.pose, end.direction), end.room});
        }
        return result;
    }
    const double distance = contact.gap + rest_;
    if (contact.state == ContactState::face || distance <= 0.0) {
        return result;
    }
    result.u = any_perpendicular(contact.normal);
    result.bend_u = 1.0 / distance;
    if (contact.state == ContactState::edge) {
        // Normal and edge are perpendicular but for rounding; only a sphere of no size at all has neither.
        const TriangleCorners t = part.part->tree()->corners(contact.feature.triangle);
        const Vec3 across =
            glm::cross(contact.normal, direction_to_parent(part.pose, edge_direction(t, contact.edge)));
        const double length = glm::length(across);
        result.u = length > 0.5 ? across / length : result.u;
    } else {
        result.bend_v = result.bend_u;
    }
    add_ends(contacts, contact, result);
    return result;
}

void ContactLook::describe(const Contact& contact, double pressure, Touch& touch) const {
    const ScenePart& part = placed(contact.feature);
    touch.point = center_ - contact.normal * (contact.gap + rest_);
    touch.normal = touch.force_direction = contact.normal;
    touch.pressure = pressure;
    touch.body = static_cast<int>(part.body);
    touch.feature = contact.feature;
    if (part.part->smooth_normals) {
        const std::uint32_t slot = contact.feature.triangle;
        const TriangleCorners t = part.part->tree()->corners(slot);
        const Vec3 smooth = interpolated_normal(
            (*part.part->smooth_normals)[part.part->tree()->triangle_at(slot)], t.a, t.b, t.c,
            to_local(part.pose, touch.point), direction_to_local(part.pose, contact.normal));
        touch.force_direction = direction_to_parent(part.pose, smooth);
    }
}

}  // namespace tactus
