// Whether a way has ended where the sphere rests, told without a look around.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

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
// it is all. A slide s over a surface that bends by b is off by s / (1 - pressure b): the length of Newton's
// step.
bool Proxy::drops_onto_one(ConstrainedStep& step, const Vec3& hand) {
    if (step.pressing_count != 1) {
        return false;
    }
    Contact& held = contacts_[step.pressing[0]];
    const ContactLook look = surroundings_.look_from(position_);
    const Contact now = look.exact_contact(held.feature);
    const Vec3 pull = hand - position_;
    const double across = glm::dot(now.normal, pull);
    const double pressure = -across - now.gap;
    step.slide = step.motion = pull - now.normal * across;
    const double slide = glm::length(step.slide);
    if (pressure <= 0.0 || slide > tolerances().step ||
        slide > tolerances().step * (1.0 - pressure * look.max_bend(now))) {
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

// Whether none of the other contacts is below rest after a way: each lies behind its plane, or is looked at.
bool Proxy::leads_clear_of_others(const Vec3& way, const ConstrainedStep& step) {
    const ContactLook look = surroundings_.look_from(position_);
    const std::span<const int> pressing(step.pressing, static_cast<std::size_t>(step.pressing_count));
    surroundings_.work().spend(1 + contacts_.count / 8);
    for (int i = 0; i < contacts_.count; ++i) {
        const Contact& other = contacts_[i];
        if (std::ranges::find(pressing, i) == pressing.end() &&
            other.gap + glm::dot(other.normal, way) < -tolerances().same &&
            look.exact_contact(other.feature).gap < -tolerances().same) {
            return false;
        }
    }
    return true;
}

// Whether a free way from a place where all contacts were found has ended where the hand lets the sphere
// rest. A place that is clear of everything, and as near to the hand as some surfaces let it be, is so for
// all: nothing has to be looked for then. What is no contact was farther away than the way is long. That a
// sweep was free would say less: it lets the sphere come nearer by half a skin, and where two surfaces are
// all but parallel that is far along them.
bool Proxy::has_come_to_rest(ConstrainedStep& step, const Vec3& from, const Vec3& hand,
                             const Descent& descent, ProxyTick& tick) {
    const auto is_within_seen = [&] { return glm::distance(position_, from) <= surroundings_.unseen_gap(); };
    if (step.pressing_count == 0 || descent.crowd.slope > 0.0 || !is_within_seen()) {
        return false;
    }
    // To drop leads on, so that it is asked again how far it is.
    const bool has_settled =
        step.bent ? drops_onto_one(step, hand) && is_within_seen() : stays_on_planes(step);
    if (!has_settled || !leads_clear_of_others(position_ - from, step)) {
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
