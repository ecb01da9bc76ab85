#include "core/teleop/stealth.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

double just_noticeable(const StealthSettings& settings, double force) {
    return std::max(settings.weber * force, settings.least_noticeable);
}

double unnoticed_change(const StealthSettings& settings, double force, double seconds) {
    return settings.share * just_noticeable(settings, force) * seconds / settings.window;
}

double max_hidden(const StealthSettings& settings, double modelled) {
    return std::max(just_noticeable(settings, modelled), settings.bound * modelled);
}

Vec3 faded(const Vec3& from, double way) {
    const double length = glm::length(from);
    return length <= way ? Vec3(0.0) : from * (1.0 - way / length);
}

}  // namespace tactus
