#include "core/tool/tool_surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "core/math/body_motion.hpp"

namespace tactus {

namespace {

constexpr double skin_share = 2e-5;  // of the tool's reach

// Of a skin: sweeps end this far above a surface.
constexpr double stop_share = 0.5;

constexpr double unknown = -std::numeric_limits<double>::infinity();  // of a sphere's room

// Of its room, or of the skin: how far the way of a sphere may be from its chord.
constexpr double sag_share = 0.25;

// A point that turns by w about an axis at the distance a leaves its chord by at most w^2 a / 8.
double sag_of(double turn, double arm) {
    return turn * turn * arm / 8.0;
}

}  // namespace

ToolWay steady_way(const Pose& pose, const RigidMotion& motion) {
    const double turn = glm::length(motion.turn);
    return {pose, moved(pose, motion), motion, 0.0, turn * turn};
}

Pose moved(const Pose& pose, const RigidMotion& motion) {
    return {pose.position + motion.way, glm::normalize(turn_by(motion.turn, 1.0) * pose.rotation)};
}

RigidMotion motion_between(const Pose& from, const Pose& to) {
    return {to.position - from.position, turn_vector(to.rotation * glm::conjugate(from.rotation))};
}

ToolSurroundings::ToolSurroundings(std::shared_ptr<const ToolShape> shape, std::size_t max_parts)
    : shape_(std::move(shape)),
      skin_(skin_share * shape_->reach),
      parts_(max_parts),
      entering_(max_parts),
      hoods_(shape_->spheres.size()),
      room_(shape_->spheres.size(), unknown),
      near_(shape_->spheres.size()),
      may_have_entered_(max_parts),
      bridges_(bridges_between(shape_->spheres)) {
    arms_.reserve(shape_->spheres.size());
    for (const ToolSphere& sphere : shape_->spheres) {
        arms_.push_back(glm::length(sphere.center));
        low_ = glm::min(low_, sphere.center - sphere.radius);
        high_ = glm::max(high_, sphere.center + sphere.radius);
    }
}

double ToolSurroundings::distance_outside_box(const Vec3& local) const {
    return glm::distance(local, glm::clamp(local, low_, high_));
}

double ToolSurroundings::way_of(const RigidMotion& motion, double arm) {
    return glm::length(motion.way) + glm::length(motion.turn) * arm;
}

void ToolSurroundings::forget() {
    std::ranges::fill(room_, unknown);
    for (SphereHood& hood : hoods_) {
        hood.forget();
    }
}

void ToolSurroundings::begin_tick(const TouchScene& scene, std::uint32_t mask, const Pose& pose, double way,
                                  double ride) {
    scene_ = &scene;
    stop_count_ = 0;
    is_first_ = true;
    const double beyond = farthest_share * shape_->reach + way + skin_;
    double approach = 0.0;
    parts_.clear(pose.position);
    entering_.clear(pose.position);
    const std::span<const ScenePart> parts = scene.parts();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const ScenePart& placed = parts[i];
        if (placed.part == nullptr || (scene.body(static_cast<int>(placed.body)).layer & mask) == 0) {
            continue;
        }
        const TouchBody& body = scene.body(static_cast<int>(placed.body));
        const Vec3 center = to_parent(placed.pose, placed.part->center);
        const double gone = (body.moved ? body.moved_by : 0.0) + body.gave_by;
        const double ball = placed.part->radius + gone;
        if (glm::distance(center, pose.position) > shape_->reach + beyond + ball) {
            continue;
        }
        const double apart = distance_outside_box(to_local(pose, center)) - ball;
        if (apart <= beyond) {
            parts_.add(static_cast<std::uint32_t>(i), center, ball);
            approach = std::max(approach, gone);
        }
        if (body.moved && apart <= ride + skin_) {
            entering_.add(static_cast<std::uint32_t>(i), center, ball);
        }
    }
    if (!scene.only_gives_since(std::exchange(revision_, scene.revision()))) {
        forget();
    } else if (approach > 0.0) {
        for (std::size_t i = 0; i < hoods_.size(); ++i) {
            hoods_[i].approach(approach);
            room_[i] -= approach;
        }
    }
}

bool ToolSurroundings::is_free(const Pose& pose, WorkBudget& work, double depth) {
    for (std::uint32_t i = 0; i < hoods_.size() && !parts_.is_empty(); ++i) {
        const double least = -depth * shape_->spheres[i].radius;
        if (room_[i] > least) {
            continue;
        }
        const Vec3 center = to_parent(pose, shape_->spheres[i].center);
        const double around = rest(i) + hood_share * shape_->reach;
        hoods_[i].gather(*scene_, parts_, center, around, around, same_share * skin_, work);
        room_[i] = hoods_[i].least(center) - rest(i);
        if (room_[i] <= least || work.is_gone()) {
            return false;
        }
    }
    return parts_.is_empty() ||
           (!is_inside(pose, work) && !is_between_spheres(pose, work) && !work.is_gone());
}

// Whether it is within a mesh that bounds a solid.
bool ToolSurroundings::is_inside(const Pose& pose, WorkBudget& work) const {
    const Vec3 point = to_parent(pose, shape_->spheres.front().center);
    bool inside = false;
    parts_.visit_within(point, 0.0, work, [&](std::uint32_t index) {
        const ScenePart& placed = scene_->parts()[index];
        inside = inside || (placed.part->closed && !work.is_gone() &&
                            placed.part->tree()->winding(to_local(placed.pose, point), work).inside());
    });
    return inside;
}

// Whether a surface parts what the tool is made of, without meeting a sphere.
bool ToolSurroundings::is_between_spheres(const Pose& pose, WorkBudget& work) const {
    return std::ranges::any_of(bridges_, [&](const ToolBridge& bridge) {
        const Vec3 from = to_parent(pose, shape_->spheres[bridge.first].center);
        const Vec3 way = to_parent(pose, shape_->spheres[bridge.second].center) - from;
        bool parted = work.is_gone();
        parts_.visit_within(from + 0.5 * way, 0.5 * glm::length(way) + 2.0 * skin_, work,
                            [&](std::uint32_t index) {
                                const ScenePart& placed = scene_->parts()[index];
                                const SphereWay swept{to_local(placed.pose, from),
                                                      direction_to_local(placed.pose, way), skin_, arrival()};
                                parted = parted || !sweep_surface(*placed.part, swept, 1.0, work).is_free();
                            });
        return parted;
    });
}

// Those of a body: they stand in the order of their numbers.
std::span<const std::uint32_t> ToolSurroundings::parts_of(int body) const {
    const TouchBody& asked = scene_->body(body);
    const std::span<const std::uint32_t> all = parts_.all();
    const auto first = std::ranges::lower_bound(all, asked.first_part);
    return {first, std::ranges::lower_bound(all, asked.first_part + asked.shape->parts.size())};
}

void ToolSurroundings::note_stop(const Stop& stop) {
    room_[stop.sphere] = 0.0;
    hoods_[stop.sphere].forget();  // it may have forgotten what has stopped it
    if (stop_count_ < max_stops) {
        stops_[static_cast<std::size_t>(stop_count_++)] = stop;
    }
}

double ToolSurroundings::straight_share(const RigidMotion& motion) const {
    const double way = glm::length(motion.way);
    const double turn = glm::length(motion.turn);
    double least = std::min(turn, 0.5);
    for (std::size_t i = 0; i < arms_.size(); ++i) {
        if (room_[i] <= way + turn * arms_[i]) {
            const double sag = sag_share * std::max(room_[i], skin_);
            if (sag_of(least, arms_[i]) > sag) {
                least = std::sqrt(8.0 * sag / arms_[i]);
            }
        }
    }
    return turn > 0.0 ? least / turn : 1.0;
}

// Of its tangents the height is linear along the way, and of all others that bound it is concave: nowhere
// does it lie below the line between both ends.
double ToolSurroundings::known_share(std::uint32_t sphere, const Vec3& from, const Vec3& to,
                                     double stop) const {
    const double begin = hoods_[sphere].least(from) - stop - arrival();
    const double end = hoods_[sphere].least(to) - stop - arrival();
    return begin <= 0.0 ? 0.0 : end > 0.0 ? 1.0 : begin / (begin - end);
}

double ToolSurroundings::sweep_sphere(std::uint32_t index, const Vec3& from, const Vec3& to, double sag,
                                      double limit, int except, WorkBudget& work) {
    const double stop = shape_->spheres[index].radius + stop_share * skin_ + sag;
    const double known = known_share(index, from, to, stop);
    if (known >= limit || work.is_gone()) {
        return std::min(known, limit);
    }
    const double length = glm::distance(from, to);
    const double reach = stop + length + skin_;
    parts_.visit_within(from, reach, work, [&](std::uint32_t part) {
        const ScenePart& placed = scene_->parts()[part];
        const Vec3 start = to_local(placed.pose, from);
        const double to_ball = glm::distance(start, placed.part->center) - placed.part->radius;
        if (static_cast<int>(placed.body) == except || to_ball > reach) {
            return;
        }
        if (work.is_gone()) {
            limit = length > 0.0 ? std::clamp((to_ball - stop) / length, 0.0, limit) : 0.0;
            return;
        }
        const SphereWay swept{start, direction_to_local(placed.pose, to - from), stop, arrival()};
        const Hit hit = sweep_surface(*placed.part, swept, limit, work);
        if (hit.found) {
            stopped_by_ = {index, part, hit.triangle};
        }
        limit = std::min(limit, hit.is_free() ? limit : hit.t);
    });
    return limit;
}

double ToolSurroundings::straight_share(const ToolWay& way) const {
    const double length = glm::length(way.motion.way);
    const double turn = glm::length(way.motion.turn);
    double share = 1.0;
    for (std::size_t i = 0; i < arms_.size(); ++i) {
        if (room_[i] <= length + turn * arms_[i] + strays(way, turn, arms_[i])) {
            const double sag = sag_share * std::max(room_[i], skin_);
            if (way.off_chord(arms_[i]) * share * share > sag) {
                share = std::sqrt(sag / way.off_chord(arms_[i]));
            }
        }
    }
    return share;
}

// A steady way is no longer than its way and its turn say. Any other is near its chord.
double ToolSurroundings::strays(const ToolWay& way, double turn, double arm) {
    return std::max(0.0, way.off_chord(arm) - sag_of(turn, arm));
}

// Nearest first: where the work ends, the others go no farther than they are known to be free.
double ToolSurroundings::free_share(const ToolWay& swing, WorkBudget& work, int except) {
    const double way = glm::length(swing.motion.way);
    const double turn = glm::length(swing.motion.turn);
    double limit = 1.0;
    stopped_by_.sphere = no_sphere;
    work.spend(static_cast<std::int64_t>(hoods_.size()) / spheres_at_a_time);
    const std::span<const std::uint32_t> met = spheres_where(
        [&](std::size_t i) { return room_[i] <= way + turn * arms_[i] + strays(swing, turn, arms_[i]); });
    for (const bool is_near : {true, false}) {
        for (std::size_t k = 0; k < met.size() && !parts_.is_empty(); ++k) {
            const std::uint32_t i = met[k];
            const double far = way + turn * arms_[i];
            const double stray = strays(swing, turn, arms_[i]);
            if (room_[i] > limit * far + stray || (room_[i] <= 0.25 * far + stray) != is_near) {
                continue;
            }
            const double sag = std::max(0.0, swing.off_chord(arms_[i]) - sag_share * skin_);
            limit = sweep_sphere(i, to_parent(swing.from, shape_->spheres[i].center),
                                 to_parent(swing.to, shape_->spheres[i].center), sag, limit, except, work);
        }
    }
    if (stopped_by_.sphere != no_sphere) {
        note_stop(stopped_by_);
    }
    return limit;
}

void ToolSurroundings::went(const RigidMotion& motion) {
    const double way = glm::length(motion.way);
    const double turn = glm::length(motion.turn);
    for (std::size_t i = 0; i < room_.size(); ++i) {
        room_[i] -= way + turn * arms_[i];
    }
}

}  // namespace tactus
