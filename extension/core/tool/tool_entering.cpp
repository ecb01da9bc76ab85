// How far bodies on their way enter a tool's spheres.
#include <algorithm>
#include <glm/geometric.hpp>

#include "core/tool/tool_surroundings.hpp"

namespace tactus {

// The spheres ask the parts, eight at a time: hundreds of both take some microseconds. A part that enters a
// sphere in this tick stands no farther from it now than both have gone.
void ToolSurroundings::find_entering(std::span<const std::uint32_t> spheres, const Pose& before,
                                     const Pose& now, double depth, WorkBudget& work) {
    std::ranges::fill(may_have_entered_, std::uint8_t{0});
    const double gone = farthest_way(motion_between(before, now));
    for (std::size_t i = 0; i < spheres.size() && !work.is_gone(); ++i) {
        const ToolSphere& sphere = shape_->spheres[spheres[i]];
        const double reach = (1.0 - depth) * sphere.radius + gone + skin_;
        entering_.visit_within(to_parent(now, sphere.center), reach, work, [&](std::uint32_t part) {
            may_have_entered_[scene_->body(static_cast<int>(scene_->parts()[part].body)).first_part] = 1;
        });
    }
}

double ToolSurroundings::share_until_entered(std::span<const std::uint32_t> spheres, int body,
                                             const Pose& before, const Pose& now, double depth,
                                             WorkBudget& work) {
    double limit = 1.0;
    for (const std::uint32_t part : parts_of(body)) {
        const ScenePart& placed = scene_->parts()[part];
        work.spend(1 + static_cast<std::int64_t>(spheres.size()) / spheres_at_a_time);
        for (const std::uint32_t i : spheres) {
            if (work.is_gone()) {
                break;
            }
            const Vec3 from = to_local(placed.previous, to_parent(before, shape_->spheres[i].center));
            const Vec3 to = to_local(placed.pose, to_parent(now, shape_->spheres[i].center));
            const double stop = (1.0 - depth) * shape_->spheres[i].radius;
            if (glm::distance(to, placed.part->center) - placed.part->radius >
                stop + glm::distance(from, to) + skin_) {
                continue;
            }
            const Hit hit = sweep_surface(*placed.part, {from, to - from, stop, arrival()}, limit, work);
            limit = hit.is_free() ? limit : std::min(limit, hit.t);
        }
    }
    return limit;
}

// Until the point, on its way, is no farther than the room from a triangle on its own.
double ToolSurroundings::share_until_near(const DeformSweep& sweep, const Vec3& from, const Vec3& to,
                                          double room, double limit, WorkBudget& work) {
    constexpr double arrived = 1e-3;  // of the tick
    constexpr int max_looks = 64;
    double t = 0.0;
    for (int i = 0; i < max_looks && t < limit; ++i) {
        const double next = sweep.free_until(t, from + (to - from) * t, to - from, room, work);
        if (next < 1.0 && next - t <= arrived) {
            return t;
        }
        t = next;
    }
    return std::min(t, limit);
}

ToolSurroundings::Entering ToolSurroundings::entered_by_form(int body, const Pose& before, const Pose& now,
                                                             double depth, WorkBudget& work) {
    Entering entering;
    const TouchBody& given = scene_->body(body);
    for (const std::uint32_t part : parts_of(body)) {
        const ScenePart& placed = scene_->parts()[part];
        const TouchPart& former = given.former->parts[part - given.first_part];
        const DeformSweep sweep(*former.tree(), *placed.part->tree());
        for (std::uint32_t i = 0; i < hoods_.size(); ++i) {
            if (cannot_be_entered(i, depth)) {
                continue;
            }
            const Vec3 from = to_local(placed.previous, to_parent(before, shape_->spheres[i].center));
            const Vec3 to = to_local(placed.pose, to_parent(now, shape_->spheres[i].center));
            const double room = (1.0 - depth) * shape_->spheres[i].radius;
            const double ball = std::max(former.radius, placed.part->radius);
            if (glm::distance(to, placed.part->center) >
                ball + room + glm::distance(from, to) + given.gave_by) {
                continue;
            }
            const double share = share_until_near(sweep, from, to, room, entering.share, work);
            if (share < entering.share) {
                const Vec3 at = from + (to - from) * share;
                double nearest = shape_->spheres[i].radius;
                Vec3 way(0.0);
                sweep.visit_near(share, at, nearest, work, [&](const DeformSweep::Seen& seen) {
                    nearest = seen.distance;
                    way = sweep.motion_of(seen, share, at);
                });
                entering = {share, direction_to_parent(placed.pose, way) * (1.0 - share)};
            }
        }
    }
    return entering;
}

}  // namespace tactus
