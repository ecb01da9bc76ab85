// Whether a way has ended where the sphere rests, told without a look around.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "core/haptics/descent.hpp"

namespace tactus {

// After a free way from a place where all contacts were found: whether the hand lets the sphere rest where it
// has ended. A place that is clear of everything, and as near to the hand as some surfaces let it be, is so
// for all: nothing has to be looked for then. What is no contact was farther away than the way is long. That
// a sweep was free would say less: it lets the sphere come nearer by half a skin, and where two surfaces are
// all but parallel that is far along them.
bool Descent::has_come_to_rest(const Vec3& from) {
    const auto is_within_seen = [&] {
        return glm::distance(sphere_.position, from) <= sphere_.surroundings.unseen_gap();
    };
    if (step_.pressing_count == 0 || hold_.crowd.is_around() || !is_within_seen()) {
        return false;
    }
    // To drop leads on, so that it is asked again how far it is.
    const bool has_settled = step_.bent ? drops_onto_one() && is_within_seen() : stays_on_planes();
    if (!has_settled || !leads_clear_of_others(sphere_.position - from)) {
        return false;
    }
    step_.drop = Vec3(0.0);
    if (grips_) {
        hold_.friction.brake(step_, sphere_, dropped_);
    }
    double residual = glm::length(step_.motion);
    for (int i = 0; i < step_.pressing_count; ++i) {
        residual += std::abs(sphere_.contacts[step_.pressing[i]].gap);
    }
    if (residual > tolerances().step) {
        return false;
    }
    keep_touching();
    end_.residual = residual;
    return true;
}

// After a free way along planes. Where the sphere is still above all that pressed, they press as they did:
// what is left of the step is known without a look.
bool Descent::stays_on_planes() {
    const ContactLook look = sphere_.look();
    for (int i = 0; i < step_.pressing_count; ++i) {
        Contact& held = sphere_.contacts[step_.pressing[i]];
        if (held.state != ContactState::face || !look.is_above_face(held)) {
            return false;
        }
        held.gap += glm::dot(held.normal, step_.motion);
    }
    step_.slide -= step_.motion - step_.drop;
    step_.motion = step_.slide;
    return true;
}

// After a free way over one bent surface, which ends above it: where nothing is left to slide, to drop onto
// it is all. A slide s over a surface that bends by b is off by s / (1 - pressure b): the length of Newton's
// step.
bool Descent::drops_onto_one() {
    if (step_.pressing_count != 1) {
        return false;
    }
    Contact& held = sphere_.contacts[step_.pressing[0]];
    const ContactLook look = sphere_.look();
    const Contact now = look.exact_contact(held.feature);
    const Vec3 pull = hand_ - sphere_.position;
    const double across = glm::dot(now.normal, pull);
    const double pressure = -across - now.gap;
    step_.slide = step_.motion = pull - now.normal * across;
    const double slide = glm::length(step_.slide);
    if (pressure <= 0.0 || slide > tolerances().step ||
        slide > tolerances().step * (1.0 - pressure * look.max_bend(now))) {
        return false;
    }
    FeatureId stopped_by;
    if (now.gap > 0.0 && !sphere_.advance(now.normal * -now.gap, stopped_by).is_free()) {
        return false;
    }
    step_.pressure[0] = pressure;
    held = now;
    held.gap = std::min(now.gap, 0.0);
    return true;
}

// Whether none of the other contacts is below rest after a way: each lies behind its plane, or is looked at.
bool Descent::leads_clear_of_others(const Vec3& way) {
    const ContactList& contacts = sphere_.contacts;
    const ContactLook look = sphere_.look();
    const std::span<const int> pressing(step_.pressing, static_cast<std::size_t>(step_.pressing_count));
    sphere_.work().spend(1 + contacts.count / 8);
    for (int i = 0; i < contacts.count; ++i) {
        const Contact& other = contacts[i];
        if (std::ranges::find(pressing, i) == pressing.end() &&
            other.gap + glm::dot(other.normal, way) < -tolerances().same &&
            look.exact_contact(other.feature).gap < -tolerances().same) {
            return false;
        }
    }
    return true;
}

}  // namespace tactus
