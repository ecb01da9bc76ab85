// Which surfaces bound a tool's next motion.
//
// Most spheres know from before how far all surfaces are. Of the others, the features are remembered as
// tangents, and the distance to what is convex bends by at most 1 / D at the distance D from it: a sphere
// that has gone by d since is off by d^2 / 2D. While that is little beside its gap, it is not looked at
// again.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "core/tool/tool_surroundings.hpp"

namespace tactus {

namespace {

constexpr double window_share = 4.0;  // of a skin
constexpr double kept_windows = 3.0;  // features are remembered as far

// By how much gaps may be too small: of themselves, and of a skin, but where a tick begins and where it ends.
constexpr double gap_error = 0.1;
constexpr double touch_error = 0.01;

}  // namespace

void ToolContacts::add(const ToolContact& contact) {
    if (count < capacity) {
        items[static_cast<std::size_t>(count++)] = contact;
        return;
    }
    ToolContact& farthest = *std::ranges::max_element(items, {}, &ToolContact::gap);
    if (contact.gap < farthest.gap) {
        farthest = contact;
    }
}

bool ToolSurroundings::has_stopped(std::uint32_t sphere, const HoodPlane& plane) const {
    return std::ranges::any_of(
        std::span(stops_).first(static_cast<std::size_t>(stop_count_)), [&](const Stop& stop) {
            return stop.sphere == sphere && stop.part == plane.part && stop.triangle == plane.triangle;
        });
}

// A hood that is full sees no farther from here: sweeps do, and what stops one makes it look anew. But what a
// tool rests on is found, and where nothing of what the hood remembers is near it is somewhere else.
void ToolSurroundings::refresh(SphereHood& hood, const Vec3& center, double rest, double window, Care care,
                               WorkBudget& work) {
    const double same = same_share * skin_;
    const auto gather = [&] {
        const double around =
            std::clamp(4.0 * window, hood_share * shape_->reach, farthest_share * shape_->reach);
        hood.gather(*scene_, parts_, center, rest + around, rest + kept_windows * window, same, work);
    };
    const double others = hood.others(center) - rest;
    if (others < window && (!hood.is_full() || hood.is_worn(0.5 * hood_share * shape_->reach))) {
        gather();
        return;
    }
    const double gap = hood.nearest(center) - rest;
    const double error = std::max(gap_error * gap, care == Care::usual ? touch_error * skin_ : 0.0);
    const double away = care == Care::exact ? 0.0 : std::sqrt(2.0 * rest * std::max(0.0, error));
    if (gap < window && !hood.is_seen_from(center, rest + window, away)) {
        hood.look(*scene_, center, rest + window, same, work);
    }
    const bool misses_touch = care == Care::exact && others < 0.0 && !hood.is_gathered_at(center);
    if (misses_touch || (others < window && hood.nearest(center) - rest >= window)) {
        gather();
    }
}

void ToolSurroundings::look_at_sphere(std::uint32_t index, const Pose& pose, double window, Care care,
                                      ToolContacts& contacts, WorkBudget& work) {
    const Vec3 center = to_parent(pose, shape_->spheres[index].center);
    const double rest = this->rest(index);
    SphereHood& hood = hoods_[index];
    work.spend(sphere_cost);
    refresh(hood, center, rest, window, care, work);
    for (const HoodPlane& plane : hood.planes()) {
        const double height = plane.at(center) - rest;
        if (height < window && (!plane.covered || has_stopped(index, plane))) {
            contacts.add({plane.point,
                          plane.normal,
                          height,
                          static_cast<int>(scene_->parts()[plane.part].body),
                          {plane.part, plane.triangle}});
        }
    }
    room_[index] = hood.least(center) - rest;
}

void ToolSurroundings::collect(const Pose& pose, const RigidMotion& motion, double far,
                               ToolContacts& contacts, WorkBudget& work, bool is_exact) {
    contacts.count = 0;
    const bool is_first = std::exchange(is_first_, false);
    const Care care = is_exact ? Care::exact : is_first ? Care::first : Care::usual;
    const double most = std::min(far, 0.5 * farthest_share * shape_->reach);
    const double way = glm::length(motion.way);
    const double turn = glm::length(motion.turn);
    const auto window_of = [&](std::size_t i) {
        return std::min(way + turn * arms_[i], most) + window_share * skin_;
    };
    work.spend(static_cast<std::int64_t>(hoods_.size()) / spheres_at_a_time);
    const std::span<const std::uint32_t> near =
        spheres_where([&](std::size_t k) { return room_[k] < window_of(k); });
    const auto first = static_cast<std::size_t>(std::ranges::lower_bound(near, next_look_) - near.begin());
    next_look_ = 0;
    for (std::size_t k = 0; k < near.size(); ++k) {
        const std::uint32_t i = near[(first + k) % near.size()];
        if (work.is_gone()) {
            next_look_ = i;
            return;
        }
        look_at_sphere(i, pose, window_of(i), care, contacts, work);
    }
}

}  // namespace tactus
