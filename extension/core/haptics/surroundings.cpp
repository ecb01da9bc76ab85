#include "core/haptics/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/haptics/nearest_surface.hpp"

namespace tactus {

namespace {

constexpr std::size_t hood_count = 12;  // meshes near one proxy whose triangles it remembers

// A mesh is remembered this many ticks' travel around the proxy: fewer means gathering more often, more means
// looking at more packs in between. Chosen by the bench `proxy`.
constexpr double ticks_remembered = 5.0;

}  // namespace

void ContactList::add(const Contact& contact) {
    if (count < capacity) {
        items[static_cast<std::size_t>(count++)] = contact;
        return;
    }
    const auto widest =
        std::ranges::max_element(items, [](const Contact& p, const Contact& q) { return p.gap < q.gap; });
    if (contact.gap < widest->gap) {
        *widest = contact;
    }
}

Surroundings::Surroundings(std::size_t most_parts)
    : records_(most_parts), hoods_(hood_count), near_triangles_(std::make_unique<NearTriangles>()) {
    far_.reserve(2 * most_parts + 1);
    near_.reserve(most_parts);
    free_hoods_.reserve(hood_count);
}

void Surroundings::begin_tick(const TouchScene& scene, const Vec3& center, double radius,
                              std::uint32_t mask) {
    const bool changed =
        scene_ != &scene || revision_ != scene.revision() || mask_ != mask || radius_ != radius;
    scene_ = &scene;
    mask_ = mask;
    radius_ = radius;
    if (changed) {
        revision_ = scene.revision();
        forget(center);
    }
    pace_ = std::max(odometer_ - odometer_at_tick_, 0.8 * pace_);
    odometer_at_tick_ = odometer_;
    for (const int index : scene.moved_bodies()) {
        const TouchBody& body = scene.body(index);
        for (std::size_t i = 0; i < body.shape->parts.size(); ++i) {
            const auto part = static_cast<std::uint32_t>(body.first_part + i);
            Record& record = records_[part];
            if (record.place == Place::absent) {
                continue;
            }
            if (record.place == Place::far) {
                make_near(part);
            }
            record.slack += body.moved_by;
        }
    }
    return_passed(center);
    retire_distant_parts();
}

bool Surroundings::pass_through(int body) {
    if (passed_count_ == most_passed) {
        return false;
    }
    passed_[passed_count_++] = body;
    return true;
}

bool Surroundings::is_passed(std::uint32_t body) const {
    for (std::size_t i = 0; i < passed_count_; ++i) {
        if (passed_[i] == static_cast<int>(body)) {
            return true;
        }
    }
    return false;
}

void Surroundings::return_passed(const Vec3& center) {
    const double room = radius_ + tolerances_.skin;
    for (std::size_t i = 0; i < passed_count_;) {
        const bool gone = !scene_->body(passed_[i]).shape;
        if (gone || nearest_surface(*scene_, passed_[i], center, 2.0 * room).distance >= room) {
            passed_[i] = passed_[--passed_count_];
        } else {
            ++i;
        }
    }
}

// Everything is far and due at once: the first question looks at each part again.
void Surroundings::forget(const Vec3& center) {
    far_.clear();
    near_.clear();
    free_hoods_.clear();
    for (std::size_t i = 0; i < hoods_.size(); ++i) {
        free_hoods_.push_back(static_cast<std::int16_t>(i));
    }
    double magnitude = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z), radius_});
    const auto parts = scene_->parts();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Record& record = records_[i];
        record = {0.0, 0.0, Place::absent, -1, record.stamp + 1};
        if (!parts[i].part || (scene_->body(static_cast<int>(parts[i].body)).layer & mask_) == 0) {
            continue;
        }
        record.place = Place::far;
        far_.push_back({odometer_, static_cast<std::uint32_t>(i), record.stamp});
        if (const TriangleTree* tree = parts[i].part->tree()) {
            magnitude = std::max(magnitude, tree->magnitude());
        }
    }
    tolerances_ = make_tolerances(radius_, magnitude);
}

void Surroundings::make_near(std::uint32_t part) {
    Record& record = records_[part];
    record.place = Place::near;
    ++record.stamp;
    record.clear_until = 0.0;
    near_.push_back(part);
}

void Surroundings::send_far(std::uint32_t part, double distance) {
    Record& record = records_[part];
    record.place = Place::far;
    ++record.stamp;
    if (record.hood >= 0) {
        free_hoods_.push_back(record.hood);
        record.hood = -1;
    }
    far_.push_back({odometer_ + distance, part, record.stamp});
    std::push_heap(far_.begin(), far_.end(), [](const Far& p, const Far& q) { return p.due > q.due; });
}

// A part that cannot be reached within the next ticks leaves the near list; a body that keeps moving stays.
void Surroundings::retire_distant_parts() {
    const double distant = 40.0 * pace_ + 0.1 * radius_;
    for (std::size_t i = 0; i < near_.size();) {
        const std::uint32_t part = near_[i];
        const Record& record = records_[part];
        const double distance = record.clear_until - odometer_for(record);
        const bool moves = scene_->body(static_cast<int>(scene_->parts()[part].body)).moved;
        if (moves || distance <= distant || far_.size() + 1 >= far_.capacity()) {
            ++i;
            continue;
        }
        near_[i] = near_.back();
        near_.pop_back();
        send_far(part, distance);
    }
}

// A lower bound of the distance between the sphere and the part.
double Surroundings::distance_bound(std::uint32_t index, const Vec3& center) const {
    const ScenePart& placed = scene_->parts()[index];
    const Vec3 local = to_local(placed.pose, center);
    const double margin = radius_ + 2.0 * tolerances_.reach + tolerances_.skin;
    if (!placed.part->tree()) {
        return distance_to_solid(placed.part->solid(), local).distance - margin;
    }
    const double to_ball = glm::length(local - placed.part->center) - placed.part->radius;
    if (to_ball > margin + placed.part->radius) {
        return to_ball - margin;
    }
    return placed.part->tree()->collect(local, 0.0, 1e30, {}).nearest - margin;
}

// Makes sure that every part within `length` of the sphere is on the near list.
void Surroundings::bring_near(double length, const Vec3& center) {
    const auto later = [](const Far& p, const Far& q) { return p.due > q.due; };
    while (!far_.empty() && far_.front().due <= odometer_ + length) {
        const Far soonest = far_.front();
        std::pop_heap(far_.begin(), far_.end(), later);
        far_.pop_back();
        if (records_[soonest.part].stamp != soonest.stamp) {
            continue;
        }
        const double distance = distance_bound(soonest.part, center);
        if (distance > 2.0 * length) {
            far_.push_back({odometer_ + distance, soonest.part, soonest.stamp});
            std::push_heap(far_.begin(), far_.end(), later);
            continue;
        }
        make_near(soonest.part);
        Record& record = records_[soonest.part];
        record.clear_until = odometer_for(record) + distance;
    }
}

// The remembered triangles around a point of the part, gathered anew where the old ones do not cover a way of
// the given length from there.
Neighbourhood* Surroundings::hood_around(std::uint32_t index, const Vec3& local, double way) {
    Record& record = records_[index];
    const double now = odometer_for(record);
    const double needed = radius_ + tolerances_.skin + tolerances_.reach + way;
    if (record.hood >= 0 && hoods_[static_cast<std::size_t>(record.hood)].covered_until - now >= needed) {
        return &hoods_[static_cast<std::size_t>(record.hood)];
    }
    if (record.hood < 0) {
        if (free_hoods_.empty()) {
            return nullptr;
        }
        record.hood = free_hoods_.back();
        free_hoods_.pop_back();
    }
    Neighbourhood& hood = hoods_[static_cast<std::size_t>(record.hood)];
    const TriangleTree& tree = *scene_->parts()[index].part->tree();
    double margin = std::max(ticks_remembered * pace_, 4.0 * tolerances_.reach);
    for (int attempt = 0; attempt < 4; ++attempt) {
        if (hood.gather(tree, local, needed + margin, now)) {
            return &hood;
        }
        margin *= 0.25;
    }
    return nullptr;
}

void Surroundings::find_solid_contact(std::uint32_t index, const Vec3& local, ContactList& out) {
    const ScenePart& placed = scene_->parts()[index];
    const SolidDistance at = distance_to_solid(placed.part->solid(), local);
    Record& record = records_[index];
    const double rest = radius_ + tolerances_.skin;
    record.clear_until = odometer_for(record) + at.distance - rest - tolerances_.reach;
    if (at.distance - rest > tolerances_.reach) {
        return;
    }
    Contact contact;
    contact.normal = direction_to_parent(placed.pose, at.normal);
    contact.force_direction = contact.normal;
    contact.u = direction_to_parent(placed.pose, at.u);
    contact.point = to_parent(placed.pose, local - at.normal * at.distance);
    contact.gap = at.distance - rest;
    contact.bend_u = at.bend_u;
    contact.bend_v = at.bend_v;
    contact.pivot = at.bend_u > 0.0 ? to_parent(placed.pose, local - at.normal / at.bend_u) : contact.point;
    contact.body = static_cast<int>(placed.body);
    out.add(contact);
}

void Surroundings::find_tree_contacts(std::uint32_t index, const Vec3& local, ContactList& out,
                                      bool keep_all) {
    const ScenePart& placed = scene_->parts()[index];
    const TriangleTree& tree = *placed.part->tree();
    const double rest = radius_ + tolerances_.skin;
    const double limit = rest + tolerances_.reach;
    const double squared_limit = limit * limit;
    const LanesVec3 center = splat(local);
    NearTriangles& near = *near_triangles_;
    near.clear();
    double nearest = std::numeric_limits<double>::infinity();

    Neighbourhood* const hood = hood_around(index, local, 0.0);
    Record& record = records_[index];
    const double now = odometer_for(record);
    const auto look = [&](std::uint32_t pack) {
        const PackOffset seen = offset_from_triangles(tree.pack(pack), center);
        for (int i = 0; i < lane_count; ++i) {
            if (seen.squared[i] <= squared_limit) {
                near.add(tree, pack, i, local);
            }
        }
        return seen;
    };
    if (hood) {
        Lanes least = splat(hood->covered_until - now);
        for (std::size_t i = 0; i < hood->count; ++i) {
            NearPack& remembered = hood->packs[i];
            Lanes distances = least_distances(remembered.bound, center);
            if (any(distances <= splat(limit))) {
                remembered.bound = bound_from(look(remembered.pack), center);
                distances = least_distances(remembered.bound, center);
            }
            least = lanes_min(least, distances);
        }
        nearest = smallest(least);
    } else {
        std::array<NearPack, Neighbourhood::capacity> packs;
        const CollectResult found = tree.collect(local, limit, limit, packs);
        for (std::size_t i = 0; i < found.count; ++i) {
            look(packs[i].pack);
        }
        nearest = found.nearest;
    }
    record.clear_until = now + nearest - limit;
    for (int i = 0; i < near.count(); ++i) {
        if (keep_all || !near.is_covered(i, tolerances_.same)) {
            out.add(near.contact(i, placed, rest));
        }
    }
}

bool Surroundings::is_clear(double length) const {
    if (!far_.empty() && far_.front().due <= odometer_ + length) {
        return false;
    }
    return std::ranges::all_of(near_, [&](std::uint32_t index) {
        return records_[index].clear_until > odometer_for(records_[index]) + length;
    });
}

void Surroundings::find_contacts(const Vec3& center, ContactList& out, bool keep_all) {
    out.clear();
    bring_near(2.0 * tolerances_.reach, center);
    for (const std::uint32_t index : near_) {
        const Record& record = records_[index];
        if (record.clear_until > odometer_for(record)) {
            continue;
        }
        const ScenePart& placed = scene_->parts()[index];
        if (is_passed(placed.body)) {
            continue;
        }
        const Vec3 local = to_local(placed.pose, center);
        if (placed.part->tree()) {
            find_tree_contacts(index, local, out, keep_all);
        } else {
            find_solid_contact(index, local, out);
        }
    }
}

// Within what is remembered, only packs that the way can reach before the earliest hit so far are looked at.
// A way that leads out of it is answered by gathering farther, or, where it is long, by the tree itself.
double Surroundings::sweep_tree(std::uint32_t index, const Vec3& start, const Vec3& motion, double length,
                                double limit) {
    const TriangleTree& tree = *scene_->parts()[index].part->tree();
    const double stop = radius_ + tolerances_.stop;
    for (const double way : {0.0, length * limit}) {
        if (way > 2.0 * ticks_remembered * pace_) {
            break;
        }
        const Neighbourhood* const hood = hood_around(index, start, way);
        if (!hood) {
            break;
        }
        const double now = odometer_for(records_[index]);
        const double reached = (hood->covered_until - now - stop - tolerances_.arrival) / length;
        const double covered = std::min(limit, std::max(reached, 0.0));
        const double t = sweep_hood(*hood, tree, start, motion, covered);
        if (t <= covered || reached >= limit) {
            return t <= covered ? t : 2.0 * limit + 1.0;
        }
    }
    return tree.sweep(start, motion, stop, tolerances_.arrival, limit);
}

double Surroundings::sweep_hood(const Neighbourhood& hood, const TriangleTree& tree, const Vec3& start,
                                const Vec3& motion, double limit) const {
    const double stop = radius_ + tolerances_.stop;
    const Lanes reached = splat(stop + tolerances_.arrival);
    double best = limit;
    bool found = false;
    // Bounds are linear: a pack that neither end of the way can touch is not touched between them.
    const LanesVec3 from = splat(start);
    LanesVec3 to = splat(start + motion * best);
    for (std::size_t i = 0; i < hood.count; ++i) {
        const NearPack& remembered = hood.packs[i];
        const Lanes least =
            lanes_min(least_distances(remembered.bound, from), least_distances(remembered.bound, to));
        if (!any(least <= reached)) {
            continue;
        }
        const double t =
            sweep_to_triangles(tree.pack(remembered.pack), start, motion, stop, tolerances_.arrival, best);
        if (t <= best) {
            best = t;
            found = true;
            to = splat(start + motion * best);
        }
    }
    return found ? best : 2.0 * limit + 1.0;
}

double Surroundings::sweep(const Vec3& center, const Vec3& motion, int except) {
    const double length = glm::length(motion);
    bring_near(length, center);
    double best = 1.0;
    bool found = false;
    for (const std::uint32_t index : near_) {
        const Record& record = records_[index];
        const ScenePart& placed = scene_->parts()[index];
        if (static_cast<int>(placed.body) == except || is_passed(placed.body) ||
            record.clear_until > odometer_for(record) + best * length) {
            continue;
        }
        const Vec3 start = to_local(placed.pose, center);
        const Vec3 way = direction_to_local(placed.pose, motion);
        const double t = placed.part->tree()
                             ? sweep_tree(index, start, way, length, best)
                             : sweep_to_solid(placed.part->solid(), start, way, radius_ + tolerances_.stop,
                                              tolerances_.arrival, best);
        if (t <= best) {
            best = t;
            found = true;
        }
    }
    return found ? best : 2.0;
}

// Seen from a moving part, the proxy is what moves. Where its way in the part's frame meets a surface, the
// part ran into the proxy there, and takes it along from that place on.
bool Surroundings::next_push(std::size_t& from, const Vec3& center, int carrier, Push& push) {
    while (from < near_.size()) {
        const std::uint32_t index = near_[from++];
        const ScenePart& placed = scene_->parts()[index];
        const TouchBody& body = scene_->body(static_cast<int>(placed.body));
        const Record& record = records_[index];
        if (!body.moved || static_cast<int>(placed.body) == carrier || is_passed(placed.body) ||
            record.clear_until > odometer_for(record)) {
            continue;
        }
        const Vec3 before = to_local(placed.previous, center);
        const Vec3 way = to_local(placed.pose, center) - before;
        const double stop = radius_ + tolerances_.stop;
        const double t =
            placed.part->tree()
                ? placed.part->tree()->sweep(before, way, stop, tolerances_.arrival, 1.0)
                : sweep_to_solid(placed.part->solid(), before, way, stop, tolerances_.arrival, 1.0);
        if (t < 1.0) {
            push = {static_cast<int>(placed.body), to_parent(placed.pose, before + way * t) - center};
            return true;
        }
    }
    return false;
}

double Surroundings::clearance(const Vec3& center, double far) const {
    double nearest = far;
    std::uint32_t looked_at = 0xffff'ffffu;
    for (const ScenePart& placed : scene_->parts()) {
        const bool touchable =
            placed.part && (scene_->body(static_cast<int>(placed.body)).layer & mask_) != 0;
        if (touchable && placed.body != looked_at) {
            looked_at = placed.body;
            nearest = nearest_surface(*scene_, static_cast<int>(placed.body), center, nearest).distance;
        }
    }
    return nearest;
}

}  // namespace tactus
