// A close look at the few contacts that matter: which edges and corners count, how the surface bends there,
// and what forces need to know of it.
#pragma once

#include "core/geometry/surface.hpp"
#include "core/haptics/contact.hpp"
#include "core/haptics/touch_scene.hpp"

namespace tactus {

// Two points closer than this many times `same` are one point: on an edge that two triangles share, the
// nearest point is found twice, with different rounding.
constexpr double same_point = 16.0;

// With a part in closed form, `at` from the sphere's centre.
Contact solid_contact(std::uint32_t part, const Pose& pose, const SolidDistance& at, double rest);

class ContactLook {
public:
    // `rest` is the distance at which the sphere's centre rests; distances that differ by at most `same` are
    // equal (unit: meters).
    ContactLook(const TouchScene& scene, const Vec3& center, double rest, double same, WorkBudget& work)
        : scene_(scene), center_(center), rest_(rest), same_(same), work_(work) {}

    // Gap and normal become exact, or the contact is covered: an edge or corner counts only where it is
    // nearest to the sphere on every triangle that shares it. Where another triangle contains the same point
    // and is nearer, the surface there is flat or concave seen from the sphere: that triangle's own contact
    // stands for it. Where several share it equally, the first owns it. Decided from the triangles at hand,
    // it needs no adjacency, and holds for T-junctions and soups, from either side.
    //
    // False where a step of the given length (unit: meters) that was found with what was seen is right still.
    bool look_closely(ContactList& contacts, int index, double step) const;
    // Many facets of one surface are told apart at once: what lies behind the plane of the nearest contact is
    // clear of whatever stays before that plane, and covered.
    void cover_behind_nearest(ContactList& contacts) const;
    Contact exact_contact(const FeatureId& feature) const;
    // Whether the sphere, gone along the plane of a face, is still above it.
    bool is_above_face(const Contact& contact) const;
    // The same asked of the tree, for a contact whose neighbours may not be among the triangles at hand.
    bool is_covered_by_any(const Contact& contact) const;
    // Of a contact that has been looked at closely: how much the distance bends at most (unit: 1/meter).
    double max_bend(const Contact& contact) const;
    // Likewise, and in which directions.
    Curvature curvature_of(const ContactList& contacts, int index) const;
    // Every field of `touch`.
    void describe(const Contact& contact, double pressure, Touch& touch) const;

private:
    const ScenePart& placed(const FeatureId& feature) const { return scene_.parts()[feature.part]; }
    SurfacePoint at(const FeatureId& feature) const;
    bool is_covered(ContactList& contacts, int index, const SurfacePoint& candidate) const;
    void add_ends(const ContactList& contacts, const Contact& contact, Curvature& out) const;

    const TouchScene& scene_;
    Vec3 center_;
    double rest_;
    double same_;
    WorkBudget& work_;
};

}  // namespace tactus
