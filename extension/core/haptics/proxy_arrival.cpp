// Whether a way has ended where the sphere rests, told without a look around.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/proxy.hpp"

namespace tactus {

// After a free way along planes. Where the sphere is still above all that pressed, they press as they did:
// what is left of the step is known without a look.
bool Proxy::stays_on_planes(ConstrainedStep& step) {
    const ContactLook look = surroundings_.look_from(position_);
    for (int i = 0; i < step.pressing_count; ++i) {
        Contact& held = contacts_[step.pressing[i]];
        if (held.state != ContactState::face || !look.is_above_face(held)) {
            return false;
        }
        held.gap += glm::dot(held.normal, step.motion);
    }
    step.slide -= step.motion - step.drop;
    step.motion = step.slide;
    return true;
}

// After a free way over one bent surface, which ends above it: where nothing is left to slide, to drop onto
// it is all.
bool Proxy::drops_onto_one(ConstrainedStep& step, const Vec3& hand) {
    if (step.pressing_count != 1) {
        return false;
    }
    Contact& held = contacts_[step.pressing[0]];
    const Contact now = surroundings_.look_from(position_).exact_contact(held.feature);
    const Vec3 pull = hand - position_;
    const double pressure = -glm::dot(now.normal, pull) - now.gap;
    step.slide = step.motion = pull - now.normal * glm::dot(now.normal, pull);
    if (pressure <= 0.0 || glm::length(step.slide) > tolerances().step) {
        return false;
    }
    FeatureId stopped_by;
    if (now.gap > 0.0 && !advance(now.normal * -now.gap, stopped_by).is_free()) {
        return false;
    }
    step.pressure[0] = pressure;
    held = now;
    held.gap = std::min(now.gap, 0.0);
    return true;
}

// Whether a free way has ended where the hand lets the sphere rest. A place that is clear of everything, and
// as near to the hand as some surfaces let it be, is so for all: nothing has to be looked for then.
bool Proxy::has_come_to_rest(ConstrainedStep& step, const Vec3& hand, bool all_seen, const Descent& descent,
                             ProxyTick& tick) {
    const bool is_squeezed = contacts_.min_gap() < -tolerances().reach;
    if (step.pressing_count == 0 || is_squeezed || descent.slope > 0.0 ||
        !(step.bent ? all_seen && drops_onto_one(step, hand) : stays_on_planes(step))) {
        return false;
    }
    step.drop = Vec3(0.0);
    if (descent.grips) {
        brake(step, descent.dropped);
    }
    double residual = glm::length(step.motion);
    for (int i = 0; i < step.pressing_count; ++i) {
        residual += std::abs(contacts_[step.pressing[i]].gap);
    }
    if (residual > tolerances().step) {
        return false;
    }
    keep_touching(step);
    tick.residual = residual;
    return true;
}

}  // namespace tactus
