#include "core/teleop/stealth.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// Below this a force has no direction worth keeping (unit: newtons): a thousandth of what is noticed.
constexpr double no_force = 1e-5;

// A factor outside its range would make much of a graze or little of a blow.
constexpr double largest_factor = 3.0;

Quat shortest_turn(const Vec3& from, const Vec3& to) {
    const Vec3 half = glm::normalize(from) + glm::normalize(to);
    const double length = glm::length(half);
    if (!(length > 1e-6)) {
        return {1.0, 0.0, 0.0, 0.0};  // opposite forces: no turn is shorter than another
    }
    const Vec3 a = glm::normalize(from), h = half / length;
    return {glm::dot(a, h), glm::cross(a, h)};
}

}  // namespace

double just_noticeable(const StealthSettings& settings, double force) {
    return std::max(settings.weber * force, settings.least_noticeable);
}

double unnoticed_change(const StealthSettings& settings, double force, double seconds) {
    return settings.share * just_noticeable(settings, force) * seconds / settings.window;
}

ForceBridge bridge(const Vec3& modelled, const Vec3& felt_before, bool keep_direction) {
    const double now = glm::length(modelled);
    const double before = glm::length(felt_before);
    if (now < no_force || before < no_force) {
        return {};
    }
    ForceBridge result;
    result.factor = std::clamp(before / now, 1.0 / largest_factor, largest_factor);
    if (keep_direction) {
        result.turn = shortest_turn(modelled, felt_before);
    }
    return result;
}

ForceBridge faded(const ForceBridge& from, double modelled_force, double change) {
    ForceBridge result = from;
    const double rest = std::max(modelled_force, no_force);
    const double step = 0.5 * change / rest;  // of the factor, and of the turn's angle
    result.factor = from.factor > 1.0 ? std::max(1.0, from.factor - step) : std::min(1.0, from.factor + step);
    const double angle = angle_between(Quat(1.0, 0.0, 0.0, 0.0), from.turn);
    const double less = step / from.factor;
    result.turn = angle <= less || angle < 1e-9
                      ? Quat(1.0, 0.0, 0.0, 0.0)
                      : glm::slerp(Quat(1.0, 0.0, 0.0, 0.0), from.turn, 1.0 - less / angle);
    return result;
}

Vec3 faded(const Vec3& offset, double way) {
    const double length = glm::length(offset);
    return length <= way ? Vec3(0.0) : offset * (1.0 - way / length);
}

}  // namespace tactus
