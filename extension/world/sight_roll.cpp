#include "world/sight_roll.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"
#include "core/math/least_turn.hpp"

namespace tactus {

namespace {

// Of the support: less is noise of the camera (unit: meters; cosine of 0.5 degrees).
constexpr double support_shift = 0.002;
constexpr double support_cosine = 0.99996;

}  // namespace

const char* word_of(SightState state) {
    switch (state) {
        case SightState::found:
            return "found";
        case SightState::tracked:
            return "tracked";
        case SightState::cut:
            return "cut";
        case SightState::hidden:
            return "hidden";
        case SightState::lost:
            break;
    }
    return "lost";
}

double lowest_confidence(const Sight& sight) {
    double lowest = sight.objects.empty() ? 0.0 : 1.0;
    for (const SightedObject& object : sight.objects) {
        lowest = std::min(lowest, object.confidence);
    }
    return lowest;
}

const SightedObject* object_of(const Sight& sight, std::uint64_t id) {
    const auto found = std::ranges::find(sight.objects, id, &SightedObject::id);
    return found != sight.objects.end() ? &*found : nullptr;
}

bool moves(const SightedObject& object) {
    return object.linear_velocity != Vec3(0.0) || object.angular_velocity != Vec3(0.0);
}

Pose pose_after(const SightedObject& object, double seconds) {
    return moves(object) ? carried_on(object.pose, object.linear_velocity, object.angular_velocity, seconds)
                         : object.pose;
}

bool is_elsewhere(const SupportPlane& plane, const SupportPlane& before) {
    return !before.is_found || std::abs(plane.offset - before.offset) >= support_shift ||
           glm::dot(plane.normal, before.normal) <= support_cosine;
}

Pose slab_under(const SupportPlane& plane, double thickness) {
    return {(plane.offset - 0.5 * thickness) * plane.normal, least_turn({0.0, 1.0, 0.0}, plane.normal)};
}

std::optional<Pose> camera_over_plane(const Sight& sight, double height) {
    if (!std::isfinite(height) || !sight.plane.is_found) {
        return std::nullopt;
    }
    const double above = glm::dot(sight.plane.normal, sight.camera.position) - sight.plane.offset;
    Pose camera = sight.camera;
    camera.rotation = glm::normalize(least_turn(sight.plane.normal, {0.0, 1.0, 0.0}) * camera.rotation);
    camera.position.y = height + above;
    return camera;
}

std::optional<Pose> camera_by_object(const Sight& sight, std::uint64_t id, const Pose& place) {
    const SightedObject* const object = object_of(sight, id);
    if (object == nullptr || object->state == SightState::lost || object->mesh < 0) {
        return std::nullopt;
    }
    return compose(place, inverse(compose(inverse(sight.camera), object->pose)));
}

std::vector<SightChange> SightChanges::since_last(const Sight& sight) {
    using Kind = SightChange::Kind;
    std::vector<SightChange> changes;
    for (const SightedObject& object : sight.objects) {
        const auto before = known_.find(object.id);
        const bool was_there = before != known_.end() && before->second != SightState::lost;
        const bool is_there = object.state != SightState::lost;
        if (is_there || was_there) {
            const Kind kind = !is_there ? Kind::lost : was_there ? Kind::updated : Kind::found;
            changes.push_back({kind, object.id, object.mesh, object.pose});
        }
        known_[object.id] = object.state;
    }
    std::erase_if(known_, [&](const auto& one) {
        const bool is_gone = object_of(sight, one.first) == nullptr;
        if (is_gone && one.second != SightState::lost) {
            changes.push_back({Kind::lost, one.first, -1, {}});
        }
        return is_gone;
    });
    return changes;
}

void SightRoll::update(const Sight& sight, const Show& show, const Hide& hide) {
    for (auto& [id, shown] : shown_) {
        shown.is_there = false;
    }
    for (const SightedObject& object : sight.objects) {
        if (object.state == SightState::lost) {
            continue;
        }
        const auto [at, is_new] = shown_.try_emplace(object.id);
        Shown& shown = at->second;
        shown.is_there = true;
        const bool is_other = shown.mesh != object.mesh || shown.hull_corners != object.hull.vertices.size();
        if (!is_new && is_other) {
            hide(shown.node);
        }
        if (is_new || is_other) {
            shown = {show(object), object.mesh, object.hull.vertices.size(), true};
        }
    }
    std::erase_if(shown_, [&](const auto& one) {
        if (!one.second.is_there) {
            hide(one.second.node);
        }
        return !one.second.is_there;
    });
}

void SightRoll::hide_all(const Hide& hide) {
    for (const auto& [id, shown] : shown_) {
        hide(shown.node);
    }
    shown_.clear();
}

std::uint64_t SightRoll::node_of(std::uint64_t object) const {
    const auto found = shown_.find(object);
    return found != shown_.end() ? found->second.node : 0;
}

}  // namespace tactus
