#include "core/haptics/nearest_body.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

constexpr std::int64_t cost_of_look = 1;  // whether a body is in reach at all, see cost

void ask(const TouchScene& scene, int slot, const Vec3& point, double within, NearestBody::Found& nearest,
         WorkBudget& work) {
    work.spend(cost_of_look);
    const TouchBody& body = scene.body(slot);
    const double limit = nearest.body >= 0 ? nearest.surface.distance : within;
    if (body.shape == nullptr ||
        glm::length(body.pose.position - point) > body.shape->reach + std::max(limit, 0.0)) {
        return;
    }
    const SurfaceHit surface = nearest_surface(*body.shape, body.pose, point, limit, work);
    if (surface.hit) {
        nearest.body = slot;
        nearest.surface = surface;
    }
}

}  // namespace

NearestBody::Found NearestBody::look(const TouchScene& scene, const Vec3& point, double within, int first,
                                     WorkBudget& work) {
    Found nearest;
    const std::size_t slots = scene.slots_in_use();
    if (first >= 0 && static_cast<std::size_t>(first) < slots) {
        ask(scene, first, point, within, nearest, work);
    }
    std::size_t asked = 0;
    for (; asked < slots && !work.is_gone(); ++asked) {
        next_ = next_ < slots ? next_ : 0;
        if (static_cast<int>(next_) != first) {
            ask(scene, static_cast<int>(next_), point, within, nearest, work);
        }
        ++next_;
    }
    nearest.asked_all = asked == slots && !work.is_gone();
    return nearest;
}

}  // namespace tactus
