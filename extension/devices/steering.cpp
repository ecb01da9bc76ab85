#include "devices/steering.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/math/shortened.hpp"

namespace tactus {

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
    return shortened(wanted, settings.reach);
}

}  // namespace tactus
