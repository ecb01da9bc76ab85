#include "core/teleop/drag_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

void DragEstimate::learn(const DragSettings& settings, const Vec3& truth, const Vec3& model, double seconds) {
    const double speed = glm::length(truth);
    if (!(speed > settings.slow) || glm::length(model) < settings.slow) {
        return;
    }
    const double missing = glm::dot(model - truth, truth / speed) / seconds;
    if (std::isfinite(missing)) {
        drag_ = std::clamp(drag_ + settings.gain * missing, -settings.largest, settings.largest);
    }
}

Vec3 DragEstimate::acceleration(const DragSettings& settings, const Vec3& velocity) const {
    const double speed = glm::length(velocity);
    return drag_ == 0.0 || !(speed > 0.0) ? Vec3(0.0) : velocity * (-drag_ / std::max(speed, settings.slow));
}

}  // namespace tactus
