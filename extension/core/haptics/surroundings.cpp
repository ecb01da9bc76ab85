#include "core/haptics/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/geometry/surface.hpp"
#include "core/haptics/nearest_surface.hpp"

namespace tactus {

namespace {

// A mesh is remembered this many ticks' travel around the sphere: fewer means gathering more often, more
// means looking at more packs in between. Chosen by the bench `proxy`.
constexpr double ticks_remembered = 2.5;
// Share of that by which its ball is put ahead of the sphere: most ways go on as they began.
constexpr double ahead_share = 0.6;

// What is within reach of the nearest surface, or of rest where that is higher.
double limit_from(double nearest, double rest, double reach, double limit) {
    return std::min(limit, std::max(rest, nearest) + reach);
}

}  // namespace

Surroundings::Surroundings(std::size_t max_parts)
    : broad_phase_(max_parts), memories_(std::make_unique<PackMemory[]>(max_memories)) {}

bool Surroundings::begin_tick(const TouchScene& scene, const Vec3& center, double radius, std::uint32_t mask,
                              const WorkBudget& work) {
    scene_ = &scene;
    radius_ = radius;
    work_ = work;
    in_mind_count_ = 0;
    ++ticks_;
    const bool changed = broad_phase_.begin_tick(scene, center, radius, mask);
    const bool passes = !passed_.empty();
    if (changed || passes) {
        insisted_count_ = 0;
    }
    passed_.update(scene, center, rest(), work_);
    return changed || passes;
}

// Whether a part may be met within `length` of the sphere.
bool Surroundings::counts(std::uint32_t part, double length, int except) const {
    const std::uint32_t body = scene_->parts()[part].body;
    return static_cast<int>(body) != except && !broad_phase_.is_clear(part, length) &&
           !passed_.contains(static_cast<int>(body));
}

// The memory of a part: its own, or the one that was least recently used.
std::size_t Surroundings::owner_of(std::uint32_t part) {
    const std::uint32_t stamp = broad_phase_.stamp(part);
    std::size_t oldest = 0;
    for (std::size_t i = 0; i < max_memories; ++i) {
        if (owners_[i].part == part && owners_[i].stamp == stamp) {
            owners_[i].used_at = ticks_;
            return i;
        }
        oldest = owners_[i].used_at < owners_[oldest].used_at ? i : oldest;
    }
    owners_[oldest] = {part, stamp, ticks_};
    memories_[oldest].clear();
    return oldest;
}

// The remembered triangles around a point of the part, gathered anew where the old ones do not cover a way of
// the given length from there. Null where they are too many: the ball is then made smaller, and not tried
// again until the sphere has moved on.
PackMemory* Surroundings::memory_around(std::uint32_t index, const Vec3& local, double way) {
    const double now = broad_phase_.reading(index);
    const double needed = rest() + tolerances().reach + way;
    const std::size_t place = owner_of(index);
    Owner& owner = owners_[place];
    PackMemory& memory = memories_[place];
    if (memory.covered_around(local) >= needed) {
        return &memory;
    }
    if (now < owner.crowded_until) {
        return nullptr;
    }
    const ScenePart& placed = scene_->parts()[index];
    const Vec3& last_way = broad_phase_.last_way();
    const double length = glm::length(last_way);
    const Vec3 heading =
        length > tolerances().reach ? direction_to_local(placed.pose, last_way / length) : Vec3(0.0);
    const double margin =
        owner.share * std::max(ticks_remembered * broad_phase_.pace(), 4.0 * tolerances().reach);
    const Vec3 center = local + heading * (ahead_share * margin);
    if (!memory.gather(*placed.part->tree(), center, needed + margin, local, needed, now, work_)) {
        owner.share = std::max(0.25 * owner.share, 1.0 / 64.0);
        owner.crowded_until = now + margin;
        return nullptr;
    }
    if (memory.count() < PackMemory::capacity / 4) {
        owner.share = std::min(1.0, 2.0 * owner.share);
    }
    return &memory;
}

bool Surroundings::is_clear(double length) const {
    return broad_phase_.far_are_clear(length) &&
           std::ranges::all_of(broad_phase_.near(),
                               [&](std::uint32_t part) { return broad_phase_.is_clear(part, length); });
}

void Surroundings::find_contacts(const Vec3& center, ContactList& out, double beyond) {
    out.clear();
    broad_phase_.bring_near(2.0 * tolerances().reach + beyond, center);
    double limit = rest() + tolerances().reach + beyond;
    for (const std::uint32_t part : broad_phase_.near()) {
        if (!counts(part, beyond, -1)) {
            continue;
        }
        const ScenePart& placed = scene_->parts()[part];
        const Vec3 local = to_local(placed.pose, center);
        if (placed.part->tree()) {
            find_tree_contacts(part, local, limit, out);
        } else {
            find_solid_contact(part, local, limit, out);
        }
    }
    // What was taken in before something nearer was found.
    const auto kept = std::remove_if(out.items.begin(), out.items.begin() + out.count,
                                     [&](const Contact& contact) { return contact.gap > limit - rest(); });
    out.count = static_cast<int>(kept - out.items.begin());
    add_in_mind(center, tolerances().reach + beyond, out);
    add_insisted(center, out);
}

void Surroundings::find_solid_contact(std::uint32_t index, const Vec3& local, double& limit,
                                      ContactList& out) {
    const ScenePart& placed = scene_->parts()[index];
    const SolidDistance at = distance_to_solid(placed.part->solid(), local);
    work_.spend(cost::solid_look);
    broad_phase_.set_clear(index, at.distance - rest() - tolerances().reach);
    if (at.distance <= limit) {
        out.add({direction_to_parent(placed.pose, at.normal),
                 at.distance - rest(),
                 {index},
                 ContactState::exact});
        limit = limit_from(at.distance, rest(), tolerances().reach, limit);
    }
}

void Surroundings::find_tree_contacts(std::uint32_t index, const Vec3& local, double& limit,
                                      ContactList& out) {
    const ScenePart& placed = scene_->parts()[index];
    const TriangleTree& tree = *placed.part->tree();
    const int first_count = out.count;
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t last_id = Hit::no_triangle;
    const auto take = [&](std::uint32_t pack, const PackBound& tangents, const Lanes& distances) {
        const double least = smallest(distances);
        nearest = std::min(nearest, least);
        limit = limit_from(least, rest(), tolerances().reach, limit);
        for (int k = 0; k < lane_count; ++k) {
            const std::uint32_t slot = pack * lane_count + static_cast<std::uint32_t>(k);
            const std::uint32_t id = tree.triangle_at(slot);
            if (distances[k] <= limit && id != last_id) {  // the last triangle fills up a pack
                work_.spend(cost::closest_point);
                last_id = id;
                const Vec3 normal = direction_to_parent(placed.pose, lane(tangents.normal, k));
                add_seen({normal, distances[k] - rest(), {index, slot}, ContactState::seen}, out);
            }
        }
    };
    double others = 0.0;
    bool is_known = false;
    if (PackMemory* const memory = memory_around(index, local, 0.0)) {
        others = memory->visit_near(tree, local, limit, broad_phase_.reading(index), work_, take);
        // What is remembered ends somewhere: in free space before the surface begins.
        const double covered = memory->covered_around(local);
        if (std::min(others, nearest) > covered) {
            others = std::max(covered, tree.least_distance(local));
        }
        is_known = limit <= std::max(covered, others);
    }
    if (!is_known) {
        out.count = first_count;
        const LanesVec3 center = splat(local);
        others = tree.visit_near(local, limit, work_, [&](std::uint32_t pack) {
            work_.spend(cost::pack_look);
            const PackBound tangents = bound_from(offset_from_triangles(tree.pack(pack), center), center);
            take(pack, tangents, least_distances(tangents, center));
        });
    }
    broad_phase_.set_clear(index, std::min(nearest, others) - rest() - tolerances().reach);
}

// An edge or corner is found once with every triangle that shares it: the first stands for all.
void Surroundings::add_seen(const Contact& contact, ContactList& out) const {
    Contact added = contact;
    const double same = tolerances().same;
    for (int i = 0; i < out.count && added.state == ContactState::seen; ++i) {
        const Contact& other = out[i];
        if (std::abs(other.gap - contact.gap) <= same && other.feature.part == contact.feature.part &&
            glm::length(other.normal - contact.normal) * (rest() + contact.gap) <= same_point * same) {
            added.state = ContactState::covered;
        }
    }
    out.add(added);
}

void Surroundings::keep_in_mind(const FeatureId& feature) {
    const auto end = in_mind_.begin() + static_cast<std::ptrdiff_t>(in_mind_count_);
    if (std::find(in_mind_.begin(), end, feature) != end) {
        return;
    }
    if (in_mind_count_ == max_in_mind) {
        std::shift_left(in_mind_.begin(), in_mind_.end(), 1);
        --in_mind_count_;
    }
    in_mind_[in_mind_count_++] = feature;
}

// What is within the limit was found already; what is covered does not count, whatever the distance.
void Surroundings::add_in_mind(const Vec3& center, double max_gap, ContactList& out) {
    const ContactLook look = look_from(center);
    for (std::size_t i = 0; i < in_mind_count_; ++i) {
        const auto is_it = [&](const Contact& other) { return other.feature == in_mind_[i]; };
        if (in_mind_[i].triangle == Hit::no_triangle || std::ranges::any_of(out.all(), is_it)) {
            continue;
        }
        const Contact contact = look.exact_contact(in_mind_[i]);
        if (contact.gap <= max_gap && !look.is_covered_by_any(contact)) {
            out.add(contact);
        }
    }
}

bool Surroundings::insist_on(const FeatureId& feature, const Vec3& center) {
    if (center != insisted_at_) {
        insisted_count_ = 0;
        insisted_at_ = center;
    }
    const auto end = insisted_.begin() + static_cast<std::ptrdiff_t>(insisted_count_);
    if (insisted_count_ == max_insisted || std::find(insisted_.begin(), end, feature) != end) {
        return false;
    }
    insisted_[insisted_count_++] = feature;
    return true;
}

void Surroundings::add_insisted(const Vec3& center, ContactList& out) {
    for (std::size_t i = 0; i < insisted_count_ && center == insisted_at_; ++i) {
        const Contact contact = look_from(center).exact_contact(insisted_[i]);
        const auto end = out.items.begin() + out.count;
        const auto same = std::find_if(
            out.items.begin(), end, [&](const Contact& other) { return other.feature == contact.feature; });
        if (same != end) {
            *same = contact;
        } else {
            out.count = std::min(out.count, ContactList::capacity - 1);
            out.add(contact);
        }
    }
}

// Within what is remembered, only packs that the way can reach before the earliest hit so far are looked at.
// A way that leads out of it is answered by gathering farther, or, where it is long, by the tree itself.
Hit Surroundings::sweep_tree(std::uint32_t index, const SphereWay& way, double limit) {
    const TriangleTree& tree = *scene_->parts()[index].part->tree();
    const double length = glm::length(way.motion);
    for (const double ahead : {0.0, length * limit}) {
        if (ahead > 2.0 * ticks_remembered * broad_phase_.pace()) {
            break;
        }
        PackMemory* const memory = memory_around(index, way.start, ahead);
        if (!memory) {
            break;
        }
        const double reached = memory->covered_share(way.start, way.motion, way.distance + way.slack);
        const Hit hit =
            memory->sweep(tree, way, std::min(limit, reached), broad_phase_.reading(index), work_);
        if (!hit.is_free() || reached >= limit) {
            return hit;
        }
    }
    return tree.sweep(way, limit, work_);
}

Hit Surroundings::sweep(const Vec3& center, const Vec3& motion, FeatureId& stopped_by, int except) {
    const double length = glm::length(motion);
    broad_phase_.bring_near(length, center);
    Hit first;
    for (const std::uint32_t part : broad_phase_.near()) {
        if (!counts(part, first.t * length, except)) {
            continue;
        }
        const ScenePart& placed = scene_->parts()[part];
        const SphereWay way{to_local(placed.pose, center), direction_to_local(placed.pose, motion),
                            radius_ + tolerances().stop, tolerances().arrival};
        const Hit hit = placed.part->tree() ? sweep_tree(part, way, first.t)
                                            : sweep_surface(*placed.part, way, first.t, work_);
        if (!hit.is_free()) {
            first = hit;
            stopped_by = {part, hit.triangle};
        }
    }
    return first;
}

// Seen from a moving part, the sphere is what moves. Where its way in the part's frame meets a surface, the
// part ran into the sphere there, and takes it along from that place on.
bool Surroundings::next_push(std::size_t& from, const Vec3& center, int carrier, Push& push) {
    while (from < broad_phase_.near().size()) {
        const std::uint32_t part = broad_phase_.near()[from++];
        const ScenePart& placed = scene_->parts()[part];
        if (!scene_->body(static_cast<int>(placed.body)).moved || !counts(part, 0.0, carrier)) {
            continue;
        }
        const Vec3 before = to_local(placed.previous, center);
        const SphereWay way{before, to_local(placed.pose, center) - before, radius_ + tolerances().stop,
                            tolerances().arrival};
        const Hit hit = sweep_surface(*placed.part, way, 1.0, work_);
        if (!hit.is_free()) {
            push = {static_cast<int>(placed.body),
                    to_parent(placed.pose, before + way.motion * hit.t) - center};
            return true;
        }
    }
    return false;
}

bool Surroundings::has_room(const Vec3& center, double room) {
    broad_phase_.bring_near(room, center);
    return std::ranges::all_of(broad_phase_.near(), [&](std::uint32_t part) {
        if (broad_phase_.is_clear(part, room)) {
            return true;
        }
        const auto body = static_cast<int>(scene_->parts()[part].body);
        const NearestSurface nearest = nearest_surface(*scene_, body, center, room, work_);
        return nearest.complete && nearest.distance >= room;
    });
}

}  // namespace tactus
