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
constexpr double ticks_remembered = 2.5;
// Share of that by which its ball is put ahead of the proxy: most ways go on as they began.
constexpr double ahead_share = 0.6;

double largest_length(const Vec3& center, double radius) {
    return std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z), radius});
}

}  // namespace

bool Surroundings::is_due_later(const Far& p, const Far& q) {
    return p.due > q.due;
}

Surroundings::Surroundings(std::size_t most_parts)
    : records_(most_parts),
      hoods_(std::make_unique<Neighbourhood[]>(hood_count)),
      near_triangles_(std::make_unique<NearTriangles>()) {
    far_.reserve(2 * most_parts + 1);
    near_.reserve(most_parts);
    free_hoods_.reserve(hood_count);
}

bool Surroundings::begin_tick(const TouchScene& scene, const Vec3& center, double radius,
                              std::uint32_t mask) {
    const bool changed = take_in_changes(scene, center, radius, mask);
    work_left_ = most_work;
    pace_ = std::max(odometer_ - odometer_at_tick_, 0.8 * pace_);
    odometer_at_tick_ = odometer_;
    last_way_ = center - center_at_tick_;
    center_at_tick_ = center;
    follow_moved_bodies();
    const bool passes = !passed_.empty();
    passed_.update(scene, center, radius_ + tolerances_.skin, work_left_);
    retire_distant_parts();
    return changed || passes || !scene.moved_bodies().empty();
}

bool Surroundings::take_in_changes(const TouchScene& scene, const Vec3& center, double radius,
                                   std::uint32_t mask) {
    const double farthest = largest_length(center, radius);
    // Bodies may have gone anywhere in ticks without this proxy.
    const bool missed = scene.ticks() > ticks_ + 1;
    ticks_ = scene.ticks();
    const bool other =
        scene_ != &scene || mask_ != mask || radius_ != radius || farthest > magnitude_ || missed;
    if (!other && revision_ == scene.revision()) {
        return false;
    }
    scene_ = &scene;
    mask_ = mask;
    radius_ = radius;
    if (other || scene.revision() - revision_ > TouchScene::remembered_changes) {
        forget_all(center);
    } else {
        const double good_for = magnitude_;
        for (std::uint64_t revision = revision_ + 1; revision <= scene.revision(); ++revision) {
            const TouchScene::Change& change = scene.change(revision);
            for (std::uint32_t i = 0; i < change.part_count; ++i) {
                forget(change.first_part + i, center);
            }
        }
        if (magnitude_ > good_for) {
            forget_all(center);
        }
    }
    revision_ = scene.revision();
    return true;
}

// What moves comes nearer by as much. A far part has been given some way to move before that matters.
void Surroundings::follow_moved_bodies() {
    for (const int index : scene_->moved_bodies()) {
        const TouchBody& body = scene_->body(index);
        for (std::size_t i = 0; i < body.shape->parts.size(); ++i) {
            const auto part = static_cast<std::uint32_t>(body.first_part + i);
            Record& record = records_[part];
            if (record.place == Place::absent) {
                continue;
            }
            record.slack += body.moved_by;
            if (record.place == Place::far && record.slack > record.slack_until) {
                make_near(part);
            }
        }
    }
}

// Everything is as far as the ball around it; what that is not enough for is looked at when it is asked for.
void Surroundings::forget_all(const Vec3& center) {
    far_.clear();
    near_.clear();
    free_hoods_.clear();
    for (std::size_t i = 0; i < hood_count; ++i) {
        free_hoods_.push_back(static_cast<std::int16_t>(i));
    }
    const double farthest = largest_length(center, radius_);
    magnitude_ = 1.1 * farthest;
    for (const ScenePart& placed : scene_->parts()) {
        if (placed.part && placed.part->tree()) {
            magnitude_ = std::max(magnitude_, placed.part->tree()->magnitude());
        }
    }
    tolerances_ = make_tolerances(radius_, magnitude_);
    for (std::size_t i = 0; i < scene_->parts().size(); ++i) {
        records_[i] = {0.0, 0.0, 0.0, Place::absent, -1, records_[i].stamp};
        forget(static_cast<std::uint32_t>(i), center);
    }
}

void Surroundings::forget(std::uint32_t part, const Vec3& center) {
    Record& record = records_[part];
    leave_near(part);
    record = {0.0, 0.0, 0.0, Place::absent, -1, record.stamp + 1};
    const ScenePart& placed = scene_->parts()[part];
    if (!placed.part || (scene_->body(static_cast<int>(placed.body)).layer & mask_) == 0) {
        return;
    }
    if (const TriangleTree* tree = placed.part->tree()) {
        magnitude_ = std::max(magnitude_, tree->magnitude());
    }
    send_far(part, std::max(0.0, distance_to_ball(part, center)));
}

void Surroundings::make_near(std::uint32_t part) {
    Record& record = records_[part];
    record.place = Place::near;
    ++record.stamp;
    record.clear_until = 0.0;
    near_.push_back(part);
}

void Surroundings::leave_near(std::uint32_t part) {
    Record& record = records_[part];
    if (record.place == Place::near) {
        std::erase(near_, part);
    }
    if (record.hood >= 0) {
        free_hoods_.push_back(record.hood);
        record.hood = -1;
    }
}

// A part that has never moved may be met after the whole distance; of one that has, half is its own.
void Surroundings::send_far(std::uint32_t part, double distance) {
    Record& record = records_[part];
    const double own = record.slack > 0.0 ? 0.5 * distance : 0.0;
    record.place = Place::far;
    record.slack_until = record.slack + own;
    push_far({odometer_ + distance - own, part, ++record.stamp});
}

// Entries that are out of date leave the heap when it is full: far rarer than entries come.
void Surroundings::push_far(const Far& far) {
    if (far_.size() == far_.capacity()) {
        std::erase_if(far_, [&](const Far& entry) { return records_[entry.part].stamp != entry.stamp; });
        std::make_heap(far_.begin(), far_.end(), &is_due_later);
    }
    far_.push_back(far);
    std::push_heap(far_.begin(), far_.end(), &is_due_later);
}

// A part that cannot be reached within the next ticks leaves the near list.
void Surroundings::retire_distant_parts() {
    for (std::size_t i = 0; i < near_.size();) {
        const std::uint32_t part = near_[i];
        const Record& record = records_[part];
        const TouchBody& body = scene_->body(static_cast<int>(scene_->parts()[part].body));
        const double distance = record.clear_until - odometer_for(record);
        if (distance <= 40.0 * (pace_ + body.moved_by) + 0.1 * radius_) {
            ++i;
            continue;
        }
        leave_near(part);
        send_far(part, distance);
    }
}

// How far the sphere is from the ball around the part, and a little less.
double Surroundings::distance_to_ball(std::uint32_t index, const Vec3& center) const {
    const ScenePart& placed = scene_->parts()[index];
    const double margin = radius_ + 2.0 * tolerances_.reach + tolerances_.skin;
    return glm::distance(center, to_parent(placed.pose, placed.part->center)) - placed.part->radius - margin;
}

// A lower bound of the distance between the sphere and the part.
double Surroundings::distance_bound(std::uint32_t index, const Vec3& center) const {
    const ScenePart& placed = scene_->parts()[index];
    const Vec3 local = to_local(placed.pose, center);
    const double margin = radius_ + 2.0 * tolerances_.reach + tolerances_.skin;
    if (!placed.part->tree()) {
        return distance_to_solid(placed.part->solid(), local).distance - margin;
    }
    const double to_ball = distance_to_ball(index, center);
    return to_ball > placed.part->radius ? to_ball : placed.part->tree()->least_distance(local) - margin;
}

// Makes sure that every part within `length` of the sphere is on the near list.
void Surroundings::bring_near(double length, const Vec3& center) {
    while (!far_.empty() && far_.front().due <= odometer_ + length) {
        const Far soonest = far_.front();
        std::pop_heap(far_.begin(), far_.end(), &is_due_later);
        far_.pop_back();
        Record& record = records_[soonest.part];
        if (record.stamp != soonest.stamp) {
            continue;
        }
        const double distance = distance_bound(soonest.part, center);
        if (distance > 4.0 * length) {
            send_far(soonest.part, distance);
            continue;
        }
        make_near(soonest.part);
        record.clear_until = odometer_for(record) + distance;
    }
}

// The remembered triangles around a point of the part, gathered anew where the old ones do not cover a way of
// the given length from there.
Neighbourhood* Surroundings::hood_around(std::uint32_t index, const Vec3& local, double way) {
    Record& record = records_[index];
    const double now = odometer_for(record);
    const double needed = radius_ + tolerances_.skin + tolerances_.reach + way;
    if (record.hood >= 0 && hoods_[static_cast<std::size_t>(record.hood)].covered_around(local) >= needed) {
        return &hoods_[static_cast<std::size_t>(record.hood)];
    }
    if (record.hood < 0) {
        if (free_hoods_.empty()) {
            return nullptr;
        }
        record.hood = free_hoods_.back();
        free_hoods_.pop_back();
        hoods_[static_cast<std::size_t>(record.hood)].clear();
    }
    Neighbourhood& hood = hoods_[static_cast<std::size_t>(record.hood)];
    const ScenePart& placed = scene_->parts()[index];
    const TriangleTree& tree = *placed.part->tree();
    const double length = glm::length(last_way_);
    const Vec3 heading =
        length > tolerances_.reach ? direction_to_local(placed.pose, last_way_ / length) : Vec3(0.0);
    double margin = std::max(ticks_remembered * pace_, 4.0 * tolerances_.reach);
    for (int attempt = 0; attempt < 4; ++attempt) {
        const Vec3 center = local + heading * (ahead_share * margin);
        if (hood.gather(tree, center, needed + margin, local, needed, now)) {
            return &hood;
        }
        margin *= 0.25;
    }
    return nullptr;
}

void Surroundings::find_solid_contact(std::uint32_t index, const Vec3& local, double beyond,
                                      ContactList& out) {
    const ScenePart& placed = scene_->parts()[index];
    const SolidDistance at = distance_to_solid(placed.part->solid(), local);
    Record& record = records_[index];
    const double gap = at.distance - (radius_ + tolerances_.skin);
    record.clear_until = odometer_for(record) + gap - tolerances_.reach;
    if (gap > tolerances_.reach + beyond) {
        return;
    }
    Contact contact;
    contact.normal = direction_to_parent(placed.pose, at.normal);
    contact.force_direction = contact.normal;
    contact.u = direction_to_parent(placed.pose, at.u);
    contact.point = to_parent(placed.pose, local - at.normal * at.distance);
    contact.gap = gap;
    contact.bend_u = at.bend_u;
    contact.bend_v = at.bend_v;
    contact.first_end = out.end_count;
    for (int i = 0; i < at.end_count; ++i) {
        const SurfaceEnd& end = at.ends[static_cast<std::size_t>(i)];
        out.add_end({direction_to_parent(placed.pose, end.direction), end.room});
    }
    contact.end_count = out.end_count - contact.first_end;
    contact.body = static_cast<int>(placed.body);
    out.add(contact);
}

// Adds the triangles within `limit` of the centre to near_triangles_. Returns a lower bound of the distance
// to the nearest one, exact where it is below `limit`.
double Surroundings::look_around(Neighbourhood& hood, const TriangleTree& tree, double now, const Vec3& local,
                                 double limit) {
    const LanesVec3 center = splat(local);
    double nearest = std::numeric_limits<double>::infinity();
    const double others = hood.visit_between(center, center, 0.0, limit, now, [&](std::size_t i) {
        --work_left_;
        const Lanes distances = hood.distances(i, tree, center, limit, now);
        for (int k = 0; k < lane_count; ++k) {
            if (distances[k] <= limit) {
                near_triangles_->add(tree, hood.pack(i), k, local);
            }
        }
        nearest = std::min(nearest, smallest(distances));
    });
    nearest = std::min(nearest, others);
    // In free space what is remembered ends long before the surface begins.
    const double covered = hood.covered_around(local);
    return nearest <= covered ? nearest : std::max(covered, tree.least_distance(local));
}

// The same where too many triangles are near to remember them.
double Surroundings::look_everywhere(const TriangleTree& tree, const Vec3& local, double limit) {
    std::array<FoundPack, 1024> packs;
    const FoundPacks found = tree.packs_within(local, limit, packs);
    const LanesVec3 center = splat(local);
    double nearest = limit;
    for (std::size_t i = 0; i < found.count; ++i) {
        --work_left_;
        const PackOffset seen = offset_from_triangles(tree.pack(packs[i].pack), center);
        for (int k = 0; k < lane_count; ++k) {
            const double distance = std::sqrt(seen.squared[k]);
            if (distance <= limit) {
                near_triangles_->add(tree, packs[i].pack, k, local);
            }
            nearest = std::min(nearest, distance);
        }
    }
    return nearest;
}

void Surroundings::find_tree_contacts(std::uint32_t index, const Vec3& local, double beyond, ContactList& out,
                                      bool keep_all) {
    const ScenePart& placed = scene_->parts()[index];
    const TriangleTree& tree = *placed.part->tree();
    const double rest = radius_ + tolerances_.skin;
    const double limit = rest + tolerances_.reach + beyond;
    near_triangles_->clear();
    Neighbourhood* const hood = hood_around(index, local, beyond);
    Record& record = records_[index];
    const double now = odometer_for(record);
    const double nearest =
        hood ? look_around(*hood, tree, now, local, limit) : look_everywhere(tree, local, limit);
    record.clear_until = now + nearest - rest - tolerances_.reach;
    for (int i = 0; i < near_triangles_->count(); ++i) {
        if (keep_all || !near_triangles_->is_covered(i, tolerances_.same)) {
            near_triangles_->add_contact(i, placed, rest, tolerances_.same, out);
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

void Surroundings::find_contacts(const Vec3& center, ContactList& out, double beyond, bool keep_all) {
    out.clear();
    bring_near(2.0 * tolerances_.reach + beyond, center);
    for (const std::uint32_t index : near_) {
        const Record& record = records_[index];
        if (record.clear_until > odometer_for(record) + beyond) {
            continue;
        }
        const ScenePart& placed = scene_->parts()[index];
        if (is_passed(placed.body)) {
            continue;
        }
        const Vec3 local = to_local(placed.pose, center);
        if (placed.part->tree()) {
            find_tree_contacts(index, local, beyond, out, keep_all);
        } else {
            find_solid_contact(index, local, beyond, out);
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
        Neighbourhood* const hood = hood_around(index, start, way);
        if (!hood) {
            break;
        }
        const double now = odometer_for(records_[index]);
        const double reached = hood->covered_share(start, motion, stop + tolerances_.arrival);
        const double covered = std::min(limit, reached);
        const double t = sweep_hood(*hood, tree, now, start, motion, covered);
        if (t <= covered || reached >= limit) {
            return t <= covered ? t : 2.0 * limit + 1.0;
        }
    }
    return tree.sweep(start, motion, stop, tolerances_.arrival, limit, work_left_);
}

double Surroundings::sweep_hood(Neighbourhood& hood, const TriangleTree& tree, double now, const Vec3& start,
                                const Vec3& motion, double limit) {
    const double stop = radius_ + tolerances_.stop;
    const double reach = stop + tolerances_.arrival;
    const double length = glm::length(motion);
    double best = limit;
    bool found = false;
    const LanesVec3 from = splat(start);
    LanesVec3 to = splat(start + motion * best);
    hood.visit_between(from, to, length * limit, reach, now, [&](std::size_t i) {
        --work_left_;
        if (!hood.may_meet(i, tree, from, to, length * best, reach, now)) {
            return;
        }
        work_left_ -= sweep_work;
        const double t =
            sweep_to_triangles(tree.pack(hood.pack(i)), start, motion, stop, tolerances_.arrival, best);
        if (t <= best) {
            best = t;
            found = true;
            to = splat(start + motion * best);
        }
    });
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
                ? placed.part->tree()->sweep(before, way, stop, tolerances_.arrival, 1.0, work_left_)
                : sweep_to_solid(placed.part->solid(), before, way, stop, tolerances_.arrival, 1.0);
        if (t < 1.0) {
            push = {static_cast<int>(placed.body), to_parent(placed.pose, before + way * t) - center};
            return true;
        }
    }
    return false;
}

bool Surroundings::has_room(const Vec3& center, double room) {
    bring_near(room, center);
    return std::ranges::all_of(near_, [&](std::uint32_t index) {
        const Record& record = records_[index];
        const auto body = static_cast<int>(scene_->parts()[index].body);
        return record.clear_until > odometer_for(record) + room ||
               nearest_surface(*scene_, body, center, 2.0 * room).distance >= room;
    });
}

}  // namespace tactus
