#include "core/proxy/slide_friction.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/haptics/friction.hpp"
#include "core/haptics/surface_feel.hpp"

namespace tactus {

namespace {

int body_of(const ProxySphere& sphere, const Contact& contact) {
    return static_cast<int>(sphere.scene->parts()[contact.feature.part].body);
}

}  // namespace

// Coulomb: contacts hold the proxy along the surface with at most friction times what they hold it back
// across (unit: meters, as all forces over the stiffness). Every wall of a groove counts. What the proxy is
// still above does not hold it, unless it has only just slid off it: a surface that bends away is `dropped`
// below after a step along it.
double SlideFriction::limit(const ConstrainedStep& step, const ProxySphere& sphere, double dropped) const {
    const double skin = sphere.tolerances().skin;
    double limit = 0.0;
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = sphere.contacts[step.pressing[i]];
        const int body = body_of(sphere, contact);
        const Feel feel = feel_at(*sphere.scene, body, contact.feature);
        const bool at_rest = contact.gap <= 4.0 * skin + dropped;
        double coefficient = friction_at(*feel.material, sliding_, speed_);
        if (feel.friction()) {
            const Vec3 point =
                sphere.position - contact.normal * (contact.gap + (sphere.settings.radius + skin));
            coefficient *= friction_share(*sphere.scene, feel, body, contact.feature, point, contact.normal);
        }
        limit += at_rest ? coefficient * step.pressure[i] : 0.0;
    }
    return limit;
}

bool SlideFriction::brake(ConstrainedStep& step, const ProxySphere& sphere, double dropped) {
    const double held = limit(step, sphere, dropped);
    const double slide = glm::length(step.slide);
    if (held <= 0.0 || slide <= 0.0) {
        return held > 0.0;
    }
    double left = std::max(0.0, slide - held);
    if (left > sphere.tolerances().step && !sliding_) {
        sliding_ = true;  // static friction has given way: what is left is held by the dynamic one
        left = std::max(0.0, slide - limit(step, sphere, dropped));
    }
    step.motion = step.drop + (step.motion - step.drop) * (left / slide);
    return true;
}

void SlideFriction::heed_speed(const ConstrainedStep& step, const ProxySphere& sphere, const Vec3& way,
                               double seconds) {
    double fall = 0.0;  // of friction with the speed, p |mu'| (unit: seconds)
    Vec3 along = way;
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = sphere.contacts[step.pressing[i]];
        const Feel feel = feel_at(*sphere.scene, body_of(sphere, contact), contact.feature);
        fall += step.pressure[i] * steepest_fall(*feel.material);
        along -= contact.normal * glm::dot(along, contact.normal);
    }
    if (fall <= 0.0) {
        speed_ = 0.0;
        return;
    }
    const double speed = glm::length(along) / seconds;
    speed_ += (speed - speed_) * (0.5 * seconds / std::max(fall, seconds));
}

}  // namespace tactus
