// Whether a way has ended where the sphere rests, told without another plan, mostly without a look around.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "core/proxy/descent.hpp"

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
    if (step_.pressing_count == 0 || hold_.crowd.is_around()) {
        return false;
    }
    if (!is_within_seen()) {
        return !step_.bent && finds_same_planes() && settles();
    }
    // To drop leads on, so that it is asked again how far it is.
    const bool has_settled = step_.bent ? drops_onto_one() && is_within_seen() : stays_on_planes();
    return has_settled && leads_clear_of_others(sphere_.position - from) && settles();
}

// Nothing holds the sphere but what did so on its way: what is left of the step, and whether that is all but
// nothing.
bool Descent::settles() {
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
    leave_slide();
    return true;
}

// The same after a way longer than what had been seen: all contacts are found at its end, as the next step
// needs them. Those that pressed are as far as their planes say, and the sphere is below none.
bool Descent::finds_same_planes() {
    if (sphere_.work().is_gone()) {
        return false;
    }
    struct Held {
        FeatureId feature;
        double gap;
    };
    std::array<Held, TouchList::capacity> held;
    ContactList& contacts = sphere_.contacts;
    for (int i = 0; i < step_.pressing_count; ++i) {
        const Contact& contact = contacts[step_.pressing[i]];
        held[static_cast<std::size_t>(i)] = {contact.feature,
                                             contact.gap + glm::dot(contact.normal, step_.motion)};
    }
    sphere_.contacts_hold = look_around();
    const double same = tolerances().same;
    if (!sphere_.contacts_hold || hold_.crowd.is_around() || contacts.min_gap() < -same) {
        return false;
    }
    for (int i = 0; i < step_.pressing_count; ++i) {
        const Held& before = held[static_cast<std::size_t>(i)];
        const auto now = std::ranges::find(contacts.all(), before.feature, &Contact::feature);
        if (now == contacts.all().end() || now->state != ContactState::face ||
            std::abs(now->gap - before.gap) > same) {
            return false;
        }
        step_.pressing[i] = static_cast<int>(now - contacts.all().begin());
    }
    leave_slide();
    return true;
}

// Of the step, after all of it was gone.
void Descent::leave_slide() {
    step_.slide -= step_.motion - step_.drop;
    step_.motion = step_.slide;
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
