#include "core/haptics/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/geometry/surface.hpp"
#include "core/geometry/surface_query.hpp"

namespace tactus {

namespace {

// A mesh is remembered this many ticks' travel around the sphere: fewer means gathering more often, more
// means looking at more packs in between. Chosen by the bench `proxy`.
constexpr double ticks_remembered = 2.5;
constexpr double strides_remembered = 2.0;
// Share of that by which its ball is put ahead of the sphere: most ways go on as they began.
constexpr double ahead_share = 0.6;
// About as many packs as are looked through in the time of one search of the tree.
constexpr double comfortable = 256.0;
// So few that more of them cost next to nothing.
constexpr double few = 48.0;
// Less than this share of the wanted margin would be used up too soon.
constexpr double least_margin = 1.0 / 16.0;
// What was crowded is believed to be so a little less each time it is left to the tree.
constexpr double forgetting = 0.95;

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
    for (std::size_t i = 0; i < max_memories; ++i) {
        if (owners_[i].part == part && owners_[i].stamp == stamp) {
            owners_[i].used_at = ticks_;
            return i;
        }
    }
    const auto least_recent = std::ranges::min_element(owners_, {}, &Owner::used_at);
    const auto oldest = static_cast<std::size_t>(least_recent - owners_.begin());
    owners_[oldest] = {part, stamp, ticks_};
    memories_[oldest].clear();
    return oldest;
}

// A ball that holds for some ticks; over rough ground, for some strides.
double Surroundings::wanted_margin() const {
    return std::max(std::min(ticks_remembered * broad_phase_.pace(), strides_remembered * stride_),
                    4.0 * tolerances().reach);
}

// The remembered triangles around a point of the part, gathered anew where the old ones do not cover a way of
// the given length from there. Null where they are too many to be worth it: the tree is asked itself then.
PackMemory* Surroundings::memory_around(std::uint32_t index, const Vec3& local, double way, bool may_gather) {
    const double now = broad_phase_.reading(index);
    const double needed = rest() + tolerances().reach + way;
    const std::size_t place = owner_of(index);
    Owner& owner = owners_[place];
    PackMemory& memory = memories_[place];
    if (memory.covered_around(local) >= needed) {
        return &memory;
    }
    if (!may_gather) {
        return nullptr;
    }
    // Of a smooth surface a ball holds as many packs as it reaches beyond the nearest of them.
    const double depth = needed - rest() - broad_phase_.clearance(index);
    const double room = comfortable / owner.density - depth;
    if (room < least_margin * wanted_margin()) {
        owner.density *= forgetting;
        return nullptr;
    }
    const ScenePart& placed = scene_->parts()[index];
    const Vec3& last_way = broad_phase_.last_way();
    const double length = glm::length(last_way);
    const Vec3 heading =
        length > tolerances().reach ? direction_to_local(placed.pose, last_way / length) : Vec3(0.0);
    const double cheap = owner.density > 0.0 ? few / owner.density - depth : 0.0;
    const double margin = std::min(room, std::max(wanted_margin(), cheap));
    const Vec3 center = local + heading * (ahead_share * margin);
    const bool gathered =
        memory.gather(*placed.part->tree(), center, needed + margin, local, needed, now, work_);
    const double packs = gathered ? static_cast<double>(memory.count()) : PackMemory::capacity;
    owner.density = std::max(packs, 0.25 * few) / std::max(depth + margin, tolerances().reach);
    return gathered ? &memory : nullptr;
}

bool Surroundings::is_clear(double length) const {
    return broad_phase_.far_are_clear(length) &&
           std::ranges::all_of(broad_phase_.near(),
                               [&](std::uint32_t part) { return broad_phase_.is_clear(part, length); });
}

// Within what is remembered, only packs that the way can reach before the earliest hit so far are looked at.
// A way that leads out of it is answered by gathering farther, or, where it is long, by the tree itself.
Hit Surroundings::sweep_tree(std::uint32_t index, const SphereWay& way, double limit) {
    const TriangleTree& tree = *scene_->parts()[index].part->tree();
    const double length = glm::length(way.motion);
    for (const double ahead : {0.0, length * limit}) {
        if (ahead > 2.0 * wanted_margin()) {
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
        const TouchBody& body = scene_->body(static_cast<int>(scene_->parts()[part].body));
        const SurfaceHit nearest = nearest_surface(*body.shape, body.pose, center, room, work_);
        return nearest.complete && nearest.distance >= room;
    });
}

}  // namespace tactus
