// The contacts of Surroundings: which are found, which are kept in mind.
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "core/proxy/surroundings.hpp"

namespace tactus {

namespace {

// Of a crowd one that is about as near as any is found with that much work, by the first branches of a tree.
constexpr std::int64_t search_in_crowd = 750;
constexpr double nothing_seen = -std::numeric_limits<double>::infinity();

}  // namespace

void Surroundings::find_contacts(const Vec3& center, ContactList& out, double beyond, double ahead) {
    out.clear();
    ContactGathering gathering(out, rest(), tolerances(), beyond, ahead);
    const auto near = bring_near(2.0 * tolerances().reach + beyond + ahead, center);
    seen_gap_ = broad_phase_.far_clearance();
    for (const std::uint32_t part : near) {
        if (!counts(part, beyond + ahead, -1)) {
            leave_out(part);
            continue;
        }
        if (work_.is_gone()) {
            seen_gap_ = nothing_seen;
            break;
        }
        const ScenePart& placed = scene_->parts()[part];
        const Vec3 local = to_local(placed.pose, center);
        if (placed.part->tree()) {
            find_tree_contacts(part, local, ahead, gathering);
        } else {
            find_solid_contact(part, local, gathering);
        }
    }
    // The limit of a full list is just below its farthest.
    if (out.is_full()) {
        seen_gap_ = std::min(seen_gap_, std::max(0.0, gathering.limit() - rest()));
    }
    drop_beyond(gathering.limit() - rest() + 2.0 * tolerances().same, out);
    make_room(out);
    add_in_mind(center, tolerances().reach + beyond + ahead, out);
    add_insisted(center, out);
}

// A part that is not asked for its contacts.
void Surroundings::leave_out(std::uint32_t part) {
    if (!passed_.contains(static_cast<int>(scene_->parts()[part].body))) {
        seen_gap_ = std::min(seen_gap_, broad_phase_.clearance(part));
    }
}

// What was taken in before something nearer was found.
void Surroundings::drop_beyond(double max_gap, ContactList& out) {
    const int count = std::exchange(out.count, 0);
    for (int i = 0; i < count; ++i) {
        if (out[i].gap <= max_gap) {
            out[out.count++] = out[i];
        } else {
            seen_gap_ = std::min(seen_gap_, out[i].gap);
        }
    }
}

void Surroundings::recall_contacts(const Vec3& center, ContactList& out, double beyond) {
    out.clear();
    seen_gap_ = nothing_seen;
    const ContactLook look = look_from(center);
    for (const FeatureId& feature : mind_.kept()) {
        const Contact contact = look.exact_contact(feature);
        if (contact.gap <= tolerances().reach + beyond) {
            out.add(contact);
        }
    }
    add_insisted(center, out);
}

void Surroundings::find_nearest_contacts(const Vec3& center, double max_gap, ContactList& out) {
    constexpr double share = 1.0 - 1e-4;
    out.clear();
    seen_gap_ = nothing_seen;
    const auto near = bring_near(max_gap, center);
    const ContactLook look = look_from(center);
    for (const std::uint32_t part : near) {
        if (work_.is_gone()) {
            break;
        }
        if (!counts(part, max_gap, -1)) {
            continue;
        }
        FeatureId feature{part};
        if (scene_->parts()[part].part->tree()) {
            const TriangleTree& tree = tree_of(part);
            const Vec3 local = to_local(scene_->parts()[part].pose, center);
            const double far = rest() + max_gap;
            const WorkShare first_branches(work_, search_in_crowd);
            const NearestTriangle nearest = tree.nearly_nearest(local, far, share, work_);
            if (nearest.distance >= far) {
                continue;
            }
            const int lane = lane_of_smallest(tree.offset_from_pack(nearest.pack, splat(local)).squared);
            feature.triangle =
                slot_in_whole(part, tree, nearest.pack * lane_count + static_cast<std::uint32_t>(lane));
        }
        if (const Contact contact = look.exact_contact(feature); contact.gap <= max_gap) {
            out.add(contact);
        }
    }
    add_in_mind(center, max_gap, out);
    add_insisted(center, out);
}

void Surroundings::find_solid_contact(std::uint32_t index, const Vec3& local, ContactGathering& out) {
    const ScenePart& placed = scene_->parts()[index];
    const SolidDistance at = distance_to_solid(placed.part->solid(), local);
    work_.spend(cost::solid_look);
    broad_phase_.set_clear(index, at.distance - rest() - tolerances().reach);
    if (at.distance <= out.limit()) {
        out.add(solid_contact(index, placed.pose, at, rest()));
        out.heed(at.distance);
    } else {
        seen_gap_ = std::min(seen_gap_, at.distance - rest());
    }
}

void Surroundings::find_tree_contacts(std::uint32_t index, const Vec3& local, double ahead,
                                      ContactGathering& out) {
    const ScenePart& placed = scene_->parts()[index];
    const TriangleTree& tree = tree_of(index);
    const int first_count = out.list().count;
    const Lanes none = splat(std::numeric_limits<double>::infinity());
    Lanes nearest = none;
    Lanes passed_by = none;  // beyond the limit
    std::uint32_t last_id = Hit::no_triangle;
    const LanesVec3 center = splat(local);
    const auto take = [&](std::uint32_t pack, const LanesVec3& normals, const Lanes& distances,
                          unsigned faces) {
        nearest = lanes_min(nearest, distances);
        out.heed(smallest(distances));
        const LaneMask within = distances <= splat(out.limit());
        passed_by = lanes_min(passed_by, select(within, none, distances));
        for (unsigned bits = lane_bits(within); bits != 0; bits &= bits - 1) {
            const int k = std::countr_zero(bits);
            const std::uint32_t slot = pack * lane_count + static_cast<std::uint32_t>(k);
            const std::uint32_t id = tree.triangle_at(slot);
            if (id == last_id) {  // the last triangle fills up a pack
                continue;
            }
            last_id = id;
            const Vec3 normal = direction_to_parent(placed.pose, lane(normals, k));
            const FeatureId feature{index, slot_in_whole(index, tree, slot)};
            const auto state = faces & 1u << k ? ContactState::face : ContactState::seen;
            add_seen({normal, distances[k] - rest(), feature, state}, out);
        }
    };
    double others = 0.0;
    bool is_known = false;
    // Above a surface a ball around the sphere ends before the surface begins.
    if (PackMemory* const memory = memory_around(index, tree, local, ahead)) {
        const double known =
            memory->visit_near(tree, local, out.limit(), broad_phase_.reading(index), work_, take);
        // What is remembered ends somewhere: in free space before the surface begins.
        const double covered = memory->covered_around(local);
        others = std::min(known, smallest(nearest)) > covered
                     ? std::max(covered, tree.least_distance(local, work_))
                     : std::min(known, covered);
        is_known = out.limit() <= others;
    }
    if (!is_known) {
        out.shorten(first_count);
        passed_by = none;
        last_id = Hit::no_triangle;
        others = tree.visit_near(local, out.limit(), work_, [&](std::uint32_t pack) {
            work_.spend(cost::contact_look);
            const PackOffset offset = tree.offset_from_pack(pack, center);
            const PackBound tangents = bound_from(offset, center);
            take(pack, tangents.normal, least_distances(tangents, center), lane_bits(offset.is_face));
        });
    }
    seen_gap_ = std::min({seen_gap_, others - rest(), smallest(passed_by) - rest()});
    broad_phase_.set_clear(index, std::min(smallest(nearest), others) - rest() - tolerances().reach);
}

// An edge or corner is found once with every triangle that shares it: the first stands for all.
void Surroundings::add_seen(const Contact& contact, ContactGathering& out) {
    work_.spend(1 + out.list().count / 32);
    Contact added = contact;
    const double same = tolerances().same;
    out.visit_as_far(contact.gap, same, [&](const Contact& other) {
        if (other.feature.part == contact.feature.part &&
            glm::length(other.normal - contact.normal) * (rest() + contact.gap) <= same_point * same) {
            added.state = ContactState::covered;
        }
    });
    out.add(added);
}

// What is within the limit was found already; what is covered does not count, whatever the distance.
void Surroundings::add_in_mind(const Vec3& center, double max_gap, ContactList& out) {
    const ContactLook look = look_from(center);
    for (const FeatureId& feature : mind_.kept()) {
        const auto is_it = [&](const Contact& other) { return other.feature == feature; };
        if (feature.triangle == Hit::no_triangle || std::ranges::any_of(out.all(), is_it)) {
            continue;
        }
        const Contact contact = look.exact_contact(feature);
        if (contact.gap <= max_gap && !look.is_covered_by_any(contact)) {
            out.add(contact);
        }
    }
}

void Surroundings::add_insisted(const Vec3& center, ContactList& out) {
    for (const FeatureId& feature : mind_.insisted_at(center)) {
        const Contact contact = look_from(center).exact_contact(feature);
        const auto end = out.items.begin() + out.count;
        const auto same = std::find_if(
            out.items.begin(), end, [&](const Contact& other) { return other.feature == contact.feature; });
        if (same != end) {
            *same = contact;
        } else {
            out.add(contact);
        }
    }
}

// For what is known: of a crowd about as near, a full list holds any, but not what has been seen to stand in
// the way.
void Surroundings::make_room(ContactList& out) {
    if (out.is_full()) {
        seen_gap_ = std::min(seen_gap_, 0.0);
        out.count -= mind_.count();
    }
}

}  // namespace tactus
