#include "core/proxy/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/geometry/surface.hpp"

namespace tactus {

namespace {

// A mesh is remembered this many ticks' travel around the sphere: fewer means gathering more often, more
// means looking at more packs in between. Chosen by the bench `proxy`.
constexpr double ticks_remembered = 2.5;
constexpr double strides_remembered = 2.0;
// Share of that by which its ball is put ahead of the sphere: most ways go on as they began.
constexpr double ahead_share = 0.6;

}  // namespace

bool Surroundings::begin_tick(const TouchScene& scene, const Vec3& center, double radius, std::uint32_t mask,
                              const WorkBudget& work) {
    scene_ = &scene;
    radius_ = radius;
    work_ = work;
    mind_.let_go();
    memories_.begin_tick();
    const bool changed = broad_phase_.begin_tick(scene, center, radius, mask);
    is_sure_ = is_sure_ && !broad_phase_.has_forgotten();
    const bool passes = !passed_.empty();
    if (changed || passes) {
        mind_.scene_has_changed();
    }
    if (passes) {
        passed_.update(scene, center, rest(), work_);
    }
    return changed || passes;
}

// Whether a part may be met within `length` of the sphere.
bool Surroundings::counts(std::uint32_t part, double length, int except) const {
    const std::uint32_t body = scene_->parts()[part].body;
    return static_cast<int>(body) != except && !broad_phase_.is_clear(part, length) &&
           !passed_.contains(static_cast<int>(body));
}

// The parts that may be met within that length, and some that are not. To go through them is counted as well.
std::span<const std::uint32_t> Surroundings::bring_near(double length, const Vec3& center) {
    constexpr std::size_t parts_a_unit = 8;
    broad_phase_.bring_near(length, center, work_);
    work_.spend(static_cast<std::int64_t>(broad_phase_.near().size() / parts_a_unit));
    return broad_phase_.near();
}

// The one that questions go to: of all triangles, or of those that the sphere can touch.
const TriangleTree& Surroundings::tree_of(std::uint32_t index) const {
    const TouchPart& part = *scene_->parts()[index].part;
    return is_sure_ ? *part.tree_for(radius_) : *part.tree();
}

bool Surroundings::fits(std::uint32_t index, const Vec3& center) {
    const ScenePart& placed = scene_->parts()[index];
    const TriangleTree* const whole = placed.part->tree();
    if (whole == placed.part->tree_for(radius_) || !counts(index, 0.0, -1)) {
        return true;
    }
    const double room = touchable_share * radius_;
    const NearestTriangle nearest = whole->nearest(to_local(placed.pose, center), room, work_, room);
    return nearest.complete && nearest.distance >= room;
}

bool Surroundings::fits_everywhere(const Vec3& center) {
    const auto near = bring_near(0.0, center);
    return broad_phase_.far_clearance() >= 0.0 &&
           std::ranges::all_of(near, [&](std::uint32_t part) { return fits(part, center); });
}

// A ball that holds for some ticks; over rough ground, for some strides.
double Surroundings::wanted_margin() const {
    return std::max(std::min(ticks_remembered * broad_phase_.pace(), strides_remembered * stride_),
                    4.0 * tolerances().reach);
}

// The remembered triangles around a point of the part, gathered anew where the old ones do not cover a way of
// the given length from there. Null where they are too many: the tree is asked itself then.
PackMemory* Surroundings::memory_around(std::uint32_t index, const TriangleTree& tree, const Vec3& local,
                                        double way) {
    const double needed = rest() + tolerances().reach + way;
    const auto [memory, is_crowded] = memories_.of(index, broad_phase_.stamp(index), tree);
    if (memory.covered_around(local) >= needed) {
        return &memory;
    }
    if (!is_crowded) {
        const ScenePart& placed = scene_->parts()[index];
        const Vec3& last_way = broad_phase_.last_way();
        const double length = glm::length(last_way);
        const double margin = wanted_margin();
        const double ahead = length > tolerances().reach ? ahead_share * margin : 0.0;
        const Vec3 heading = direction_to_local(placed.pose, last_way / std::max(length, 1e-300));
        memory.gather(tree, local + heading * ahead, needed + 2.0 * margin, ahead,
                      broad_phase_.reading(index), work_);
        if (memory.covered_around(local) >= needed) {
            return &memory;
        }
    }
    is_crowded = true;
    return nullptr;
}

bool Surroundings::is_clear(double length) const {
    return broad_phase_.far_clearance() > length &&
           std::ranges::all_of(broad_phase_.near(),
                               [&](std::uint32_t part) { return broad_phase_.is_clear(part, length); });
}

// What is remembered answers for a way as far as it covers it, the tree itself for a long one.
Hit Surroundings::sweep_tree(std::uint32_t index, const SphereWay& way, double limit) {
    const TriangleTree& tree = tree_of(index);
    const double length = glm::length(way.motion) * limit;
    const double margin = wanted_margin();
    if (PackMemory* const memory = memory_around(index, tree, way.start, std::min(length, margin))) {
        const double known =
            length <= margin ? limit : memory->covered_share(way.start, way.motion, way.distance + way.slack);
        const Hit hit = memory->sweep(tree, way, std::min(limit, known), broad_phase_.reading(index), work_);
        if (!hit.is_free() || known >= limit) {
            return hit;
        }
    }
    return tree.sweep(way, limit, work_);
}

SphereWay Surroundings::way_in(std::uint32_t part, const Vec3& center, const Vec3& motion) const {
    const Pose& pose = scene_->parts()[part].pose;
    return {to_local(pose, center), direction_to_local(pose, motion), radius_ + tolerances().stop,
            tolerances().arrival};
}

// `first`: what ends the way so far.
void Surroundings::sweep_part(std::uint32_t index, const Vec3& center, const Vec3& motion, Hit& first,
                              FeatureId& stopped_by) {
    const TouchPart& part = *scene_->parts()[index].part;
    const SphereWay way = way_in(index, center, motion);
    const Hit hit = part.tree() ? sweep_tree(index, way, first.t) : sweep_surface(part, way, first.t, work_);
    if (!hit.is_free()) {
        first = hit;
        const bool is_triangle = part.tree() && hit.triangle != Hit::no_triangle;
        stopped_by = {index, is_triangle ? slot_in_whole(index, tree_of(index), hit.triangle) : hit.triangle};
    }
}

// Through the parts that may be met within a length, as `may_be_met` says. With the work gone a part is as
// far away as is already known, and one that is not near as the broad phase knows.
template <class MayBeMet>
Hit Surroundings::sweep_parts(const Vec3& center, const Vec3& motion, FeatureId& stopped_by,
                              MayBeMet&& may_be_met) {
    const double length = glm::length(motion);
    const auto near = bring_near(length, center);
    Hit first;
    const auto end_at = [&](double distance) {
        first = {length > 0.0 ? std::clamp(distance / length, 0.0, first.t) : 0.0, false, false};
    };
    if (const double far = broad_phase_.far_clearance(); far < length) {
        end_at(far);
    }
    for (const std::uint32_t part : near) {
        if (!may_be_met(part, first.t * length)) {
            continue;
        }
        if (work_.is_gone()) {
            end_at(broad_phase_.clearance(part));
            stopped_by = {part};
        } else {
            sweep_part(part, center, motion, first, stopped_by);
        }
    }
    return first;
}

Hit Surroundings::sweep(const Vec3& center, const Vec3& motion, FeatureId& stopped_by, int except) {
    return sweep_parts(center, motion, stopped_by,
                       [&](std::uint32_t part, double length) { return counts(part, length, except); });
}

Hit Surroundings::sweep_on(const Vec3& center, const Vec3& motion, LongSweep& asked, FeatureId& stopped_by) {
    const TouchPart* const dense = scene_->parts()[asked.part].part;
    if (!dense || !dense->tree()) {
        asked.is_done = true;
        return sweep(center, motion, stopped_by);
    }
    const Hit first = sweep_parts(center, motion, stopped_by, [&](std::uint32_t part, double length) {
        return part != asked.part && counts(part, length, -1);
    });
    const TriangleTree& tree = tree_of(asked.part);
    if (asked.lineage != tree.lineage()) {
        asked = {asked.part, tree.lineage()};
    }
    Hit& hit = asked.progress.hit;
    if (first.t < hit.t) {
        hit = {};
        hit.t = first.t;
    }
    asked.is_done = tree.sweep_on(way_in(asked.part, center, motion), asked.progress, work_);
    if (!asked.is_done) {
        return {0.0, false, false};
    }
    if (hit.found) {
        stopped_by = {asked.part, slot_in_whole(asked.part, tree, hit.triangle)};
        return hit;
    }
    return first;
}

// Seen from a moving part, the sphere is what moves. Where its way in the part's frame meets a surface, the
// part ran into the sphere there, and takes it along from that place on.
bool Surroundings::next_push(std::size_t& from, const Vec3& center, int carrier, Push& push) {
    while (from < broad_phase_.near().size() && !work_.is_gone()) {
        const std::uint32_t part = broad_phase_.near()[from++];
        const ScenePart& placed = scene_->parts()[part];
        if (!scene_->body(static_cast<int>(placed.body)).moved || !counts(part, 0.0, carrier)) {
            continue;
        }
        const Vec3 before = to_local(placed.previous, center);
        const SphereWay way{before, to_local(placed.pose, center) - before, radius_ + tolerances().stop,
                            tolerances().arrival};
        const Hit hit = placed.part->tree() ? tree_of(part).sweep(way, 1.0, work_)
                                            : sweep_surface(*placed.part, way, 1.0, work_);
        if (!hit.is_free()) {
            push = {static_cast<int>(placed.body),
                    to_parent(placed.pose, before + way.motion * hit.t) - center};
            return true;
        }
    }
    return false;
}

bool Surroundings::has_room_beside(std::uint32_t part, const Vec3& center, double room) {
    if (broad_phase_.is_clear(part, 0.0)) {
        return true;
    }
    if (work_.is_gone()) {
        return false;
    }
    const ScenePart& placed = scene_->parts()[part];
    if (!placed.part->tree()) {
        work_.spend(cost::solid_look);
        const double distance =
            distance_to_solid(placed.part->solid(), to_local(placed.pose, center)).distance;
        broad_phase_.set_clear(part, distance - rest() - tolerances().reach);
        return distance >= room;
    }
    const TouchBody& body = scene_->body(static_cast<int>(placed.body));
    const Overlap at = overlap_with(*body.shape, body.pose, center, room, room, Insides::of_solids, work_);
    return at.known && at.distance >= room;
}

bool Surroundings::has_room(const Vec3& center, double room) {
    const auto near = bring_near(0.0, center);
    return broad_phase_.far_clearance() >= 0.0 &&
           std::ranges::all_of(near, [&](std::uint32_t part) { return has_room_beside(part, center, room); });
}

}  // namespace tactus
