#include "devices/steering.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

Vec3 no_longer_than(double limit, const Vec3& vector) {
    const double length = glm::length(vector);
    return length > limit ? vector * (limit / length) : vector;
}

}  // namespace

Vec3 effective_deflection(const Vec3& deflection, double dead_zone) {
    const double length = glm::length(deflection);
    if (!(length > dead_zone)) {
        return Vec3(0.0);  // no number, too
    }
    return deflection / length * std::min(1.0, (length - dead_zone) / (1.0 - dead_zone));
}

Vec3 steered(const Vec3& place, const Vec3& deflection, const SteeringSettings& settings, double seconds) {
    const Vec3 effective = effective_deflection(deflection, settings.dead_zone);
    const Vec3 wanted = settings.mode == SteeringMode::position
                            ? settings.reach * effective
                            : place + settings.speed * seconds * effective;
    return no_longer_than(settings.reach, wanted);
}

}  // namespace tactus
