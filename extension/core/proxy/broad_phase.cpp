#include "core/proxy/broad_phase.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/tree/triangle_tree.hpp"
#include "core/tree/work.hpp"

namespace tactus {

namespace {

// A magnitude below this share of what the tolerances are good for, for so many ticks, makes them finer
// again.
constexpr double much_smaller = 1.0 / 16.0;
constexpr std::uint32_t patience = 1'000;

double largest_coordinate(const Vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// The largest number that the distance between the sphere and a part is made of: its place, how far the
// sphere is from there (as the part sees it, turned), and the corners of a mesh. The far sides of a solid
// have no say: only the side that is near does, and that is no farther than the sphere.
double magnitude_of(const ScenePart& placed, const Vec3& center) {
    const double corners = placed.part->tree() ? placed.part->tree()->magnitude() : 0.0;
    return std::max(
        {corners, largest_coordinate(placed.pose.position), glm::length(center - placed.pose.position)});
}

}  // namespace

BroadPhase::BroadPhase(std::size_t max_parts) : records_(max_parts) {
    far_.reserve(2 * max_parts + 1);
    near_.reserve(max_parts);
}

bool BroadPhase::begin_tick(const TouchScene& scene, const Vec3& center, double radius, std::uint32_t mask) {
    has_forgotten_ = take_in_changes(scene, center, radius, mask);
    pace_ = std::max(odometer_ - odometer_at_tick_, 0.8 * pace_);
    odometer_at_tick_ = odometer_;
    last_way_ = center - center_at_tick_;
    center_at_tick_ = center;
    for (const int body : scene.moved_bodies()) {
        follow_moved(scene.body(body));
    }
    retire_distant_parts();
    check_theorem(center);
    return has_forgotten_ || !scene.moved_bodies().empty();
}

bool BroadPhase::take_in_changes(const TouchScene& scene, const Vec3& center, double radius,
                                 std::uint32_t mask) {
    // Bodies may have gone anywhere in ticks without this proxy.
    const bool missed = scene.ticks() > ticks_ + 1;
    ticks_ = scene.ticks();
    const bool other = scene_ != &scene || mask_ != mask || radius_ != radius || missed;
    const double magnitude = scene_ == &scene ? magnitude_near(center, radius) : 0.0;
    const bool rescaled = needs_other_tolerances(magnitude);
    if (!other && !rescaled && revision_ == scene.revision()) {
        return false;
    }
    scene_ = &scene;
    mask_ = mask;
    radius_ = radius;
    if (other || rescaled || scene.revision() - revision_ > TouchScene::remembered_changes) {
        magnitude_ = 1.1 * std::max({magnitude, largest_coordinate(center), radius});
        smaller_ticks_ = 0;
        forget_all(center);
    } else {
        for (std::uint64_t revision = revision_ + 1; revision <= scene.revision(); ++revision) {
            const TouchScene::Change& change = scene.change(revision);
            for (std::uint32_t i = 0; i < change.part_count; ++i) {
                forget(change.first_part + i, center);
            }
        }
    }
    revision_ = scene.revision();
    return true;
}

double BroadPhase::magnitude_near(const Vec3& center, double radius) const {
    double magnitude = std::max(largest_coordinate(center), radius);
    for (const std::uint32_t part : near_) {
        const ScenePart& placed = scene_->parts()[part];
        magnitude = placed.part ? std::max(magnitude, magnitude_of(placed, center)) : magnitude;
    }
    return magnitude;
}

// Coarser at once, where rounding would show; finer again after a while, because all that is known goes with
// it.
bool BroadPhase::needs_other_tolerances(double magnitude) {
    smaller_ticks_ = magnitude < much_smaller * magnitude_ ? smaller_ticks_ + 1 : 0;
    return magnitude > magnitude_ || smaller_ticks_ > patience;
}

// What moves comes nearer by as much. A far part has been given some way to move before that matters, and is
// given half of what is left then: as long as that is far, nobody has to look at it.
void BroadPhase::follow_moved(const TouchBody& body) {
    for (std::size_t i = 0; i < body.shape->parts.size(); ++i) {
        const auto part = static_cast<std::uint32_t>(body.first_part + i);
        Record& record = records_[part];
        if (record.place == Place::absent) {
            continue;
        }
        record.own_way += body.moved_by;
        if (record.place == Place::far && record.own_way > record.own_way_until) {
            if (const double distance = clearance(part); is_distant(part, distance)) {
                send_far(part, distance);
            } else {
                make_near(part);
            }
        }
    }
}

// Everything is as far as the ball around it; what that is not enough for is looked at when it is asked for.
void BroadPhase::forget_all(const Vec3& center) {
    far_.clear();
    near_.clear();
    tolerances_ = make_tolerances(radius_, magnitude_);
    for (std::size_t i = 0; i < scene_->parts().size(); ++i) {
        records_[i] = {.stamp = records_[i].stamp};
        forget(static_cast<std::uint32_t>(i), center);
    }
}

void BroadPhase::forget(std::uint32_t part, const Vec3& center) {
    Record& record = records_[part];
    leave_near(part);
    record = {.stamp = record.stamp + 1};
    const ScenePart& placed = scene_->parts()[part];
    if (!placed.part || (scene_->body(static_cast<int>(placed.body)).layer & mask_) == 0) {
        return;
    }
    send_far(part, std::max(0.0, distance_to_ball(part, center)));
}

void BroadPhase::make_near(std::uint32_t part) {
    Record& record = records_[part];
    record.place = Place::near;
    ++record.stamp;
    record.index = static_cast<std::uint32_t>(near_.size());
    near_.push_back(part);
}

void BroadPhase::leave_near(std::uint32_t part) {
    if (records_[part].place == Place::near) {
        const std::uint32_t index = records_[part].index;
        near_[index] = near_.back();
        records_[near_[index]].index = index;
        near_.pop_back();
        records_[part].place = Place::absent;
    }
}

// A part that has never moved may be met after the whole distance; of one that has, half is its own.
void BroadPhase::send_far(std::uint32_t part, double distance) {
    Record& record = records_[part];
    const double own = record.own_way > 0.0 ? 0.5 * distance : 0.0;
    record.place = Place::far;
    set_clear(part, distance);
    record.own_way_until = record.own_way + own;
    push_far({odometer_ + distance - own, part, ++record.stamp});
}

// Entries that are out of date leave the heap when it is full: far rarer than entries come.
void BroadPhase::push_far(const Far& far) {
    if (far_.size() == far_.capacity()) {
        std::erase_if(far_, [&](const Far& entry) { return records_[entry.part].stamp != entry.stamp; });
        std::make_heap(far_.begin(), far_.end(), &is_due_later);
    }
    far_.push_back(far);
    std::push_heap(far_.begin(), far_.end(), &is_due_later);
}

// Whether a part at that distance cannot be reached within the next ticks.
bool BroadPhase::is_distant(std::uint32_t part, double distance) const {
    const TouchBody& body = scene_->body(static_cast<int>(scene_->parts()[part].body));
    return distance > 40.0 * (pace_ + body.moved_by) + 0.1 * radius_;
}

void BroadPhase::retire_distant_parts() {
    for (std::size_t i = 0; i < near_.size();) {
        const std::uint32_t part = near_[i];
        if (const double distance = clearance(part); is_distant(part, distance)) {
            leave_near(part);
            send_far(part, distance);
        } else {
            ++i;
        }
    }
}

// How far the sphere is from the ball around the part, and a little less.
double BroadPhase::distance_to_ball(std::uint32_t index, const Vec3& center) const {
    const ScenePart& placed = scene_->parts()[index];
    return glm::distance(center, to_parent(placed.pose, placed.part->center)) - placed.part->radius -
           margin();
}

// A lower bound of the distance between the sphere and the part.
double BroadPhase::distance_bound(std::uint32_t index, const Vec3& center, WorkBudget& work) const {
    const ScenePart& placed = scene_->parts()[index];
    const Vec3 local = to_local(placed.pose, center);
    if (!placed.part->tree()) {
        work.spend(cost::solid_look);
        return distance_to_solid(placed.part->solid(), local).distance - margin();
    }
    const double to_ball = distance_to_ball(index, center);
    return to_ball > placed.part->radius ? to_ball
                                         : placed.part->tree()->least_distance(local, work) - margin();
}

void BroadPhase::bring_near(double length, const Vec3& center, WorkBudget& work) {
    while (far_clearance() <= length && !work.is_gone()) {
        const Far soonest = far_.front();
        work.spend(cost::far_part);
        std::pop_heap(far_.begin(), far_.end(), &is_due_later);
        far_.pop_back();
        Record& record = records_[soonest.part];
        if (record.stamp != soonest.stamp) {
            continue;
        }
        const double distance = distance_bound(soonest.part, center, work);
        if (distance > 4.0 * length) {
            send_far(soonest.part, distance);
            continue;
        }
        make_near(soonest.part);
        set_clear(soonest.part, distance);
    }
}

// The theorem, asked of the surfaces themselves: one part a tick.
void BroadPhase::check_theorem([[maybe_unused]] const Vec3& center) const {
#if !defined(NDEBUG)
    if (near_.empty()) {
        return;
    }
    const std::uint32_t part = near_[scene_->ticks() % near_.size()];
    const double clear = records_[part].clear_until - reading(part);
    const ScenePart& placed = scene_->parts()[part];
    if (clear > 0.0 && placed.part->tree()) {
        WorkBudget work(2'000);
        const double claimed = (radius_ + clear) * (1.0 - 1e-12) - tolerances_.skin;
        assert(placed.part->tree()->nearest(to_local(placed.pose, center), claimed, work).distance >=
               claimed);
    }
#endif
}

}  // namespace tactus
