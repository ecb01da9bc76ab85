// One step of the proxy: where it may go next, and how far to believe in that.
#include <algorithm>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "core/haptics/friction.hpp"
#include "core/haptics/proxy.hpp"
#include "core/haptics/surface_feel.hpp"

namespace tactus {

namespace {

constexpr int few_contacts = 16;  // are told apart as soon one by one
// On shorter ways (of the radius), and in fewer steps, it is the single facet that bends the step.
constexpr double least_whole = 1e-3;
constexpr int least_planned = 4;

}  // namespace

// The step towards the hand over what is known of the contacts. Those that hold it back are looked at closely
// first; what that changes may let others press.
ConstrainedStep Proxy::plan(const Vec3& pull, Descent& descent) {
    WorkBudget& work = surroundings_.work();
    const ContactLook look = surroundings_.look_from(position_);
    const double length = glm::length(pull);
    ConstrainedStep step;
    if (contacts_.count > few_contacts) {
        look.cover_behind_nearest(contacts_);
    }
    for (bool again = true; again;) {
        step = flat_step(pull, contacts_, tolerances().same, work);
        again = false;
        for (int i = 0; i < step.pressing_count && !work.is_gone(); ++i) {
            if (contacts_[step.pressing[i]].state == ContactState::seen) {
                again = look.look_closely(contacts_, step.pressing[i], length) || again;
            }
        }
    }
    bool is_flat = true;
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts_[step.pressing[i]];
        surroundings_.keep_in_mind(contact.feature);
        is_flat = is_flat && contact.state == ContactState::face;
    }
    if (step.pressing_count == 0 || (is_flat && is_end(step))) {
        return step;
    }
    doubt(step, pull, descent);
    follow_whole(step, pull, descent);
    if (step.bent || is_flat || step.pressing_count == TouchList::capacity) {
        return step;
    }
    const auto curvature = [&](int i) {
        return i < step.pressing_count ? look.curvature_of(contacts_, step.pressing[i]) : Curvature{};
    };
    const Curvature curvatures[] = {curvature(0), curvature(1)};
    bend_step(step, pull, contacts_, {curvatures, static_cast<std::size_t>(step.pressing_count)},
              {settings_.radius, tolerances().same, std::min(descent.trust, descent.foreseen)}, work);
    return step;
}

// Flat steps never lead away from the hand, bent ones may, and several may lead around in a circle. What
// counts is how far from the hand the proxy is once it has dropped onto what holds it back: the gradient of
// half that distance's square is the flat slide, and a step that ends at the nearest place of a parabola wins
// half of what the gradient promises. Where a bent step has won as much, the next is trusted twice as far as
// it went; half as far where it has won less, and a quarter where nothing. A step that was stopped was
// planned without what has stopped it, the next one mostly over what is in mind alone: both promise too much,
// and show nothing.
void Proxy::doubt(const ConstrainedStep& step, const Vec3& pull, Descent& descent) const {
    if (descent.was_stopped) {
        return;
    }
    const double distance = glm::distance(pull, step.drop);
    const bool has_won = distance < descent.nearest - tolerances().same;
    if (has_won) {
        descent.nearest = distance;
    }
    const BentStep& last = descent.last_bent;
    if (last.length > 0.0) {
        const double won = 0.5 * (last.distance * last.distance - distance * distance);
        const bool kept_promise = won >= 0.5 * last.slide * last.length;
        descent.trust = (!has_won ? 0.25 : kept_promise ? 2.0 : 0.5) * last.length;
    }
}

// A surface of many small facets bends as a whole otherwise than any of them. What pushes the sphere out
// turns on its way there: by how much on the last way is the bend of the whole along the slide (unit:
// 1/meters, above 0 on a hill), and a Newton step on the Lagrangian is the slide over 1 - pressure * bend.
void Proxy::follow_whole(ConstrainedStep& step, const Vec3& pull, Descent& descent) const {
    const Vec3 push = step.drop + step.slide - pull;
    const Vec3 pushed = std::exchange(descent.pushed, push);
    const Vec3 moved = position_ - std::exchange(descent.began, position_);
    const double way = glm::length(moved);
    const double slide = glm::length(step.slide);
    ++descent.planned;
    descent.foreseen = std::numeric_limits<double>::infinity();
    if (way <= 0.0 || slide <= tolerances().step) {
        return;
    }
    const double pressure = glm::length(push);
    const Vec3 normal = push / std::max(pressure, 1e-300);
    const Vec3 turned = normal - pushed / std::max(glm::length(pushed), 1e-300);
    const Vec3 along = step.slide / slide;
    const double bend = glm::dot(turned, along) / way;
    const double curvature = 1.0 - pressure * bend;
    if (bend < 0.0 && descent.stops >= 2) {
        follow_hollow(step, slide / curvature, bend, normal, way, descent.trust);
    } else if (bend > 0.0 && descent.planned >= least_planned && slide > least_whole * settings_.radius &&
               glm::dot(moved, along) > 0.7 * way) {
        follow_hill(step, curvature > 0.0 ? slide / curvature : 0.5 / bend, way, descent);
    }
}

// Each facet would stop the sphere. It ends as far above them as the hollow rises on the way; they are found
// below it then. Of use where it goes farther than a few facets.
void Proxy::follow_hollow(ConstrainedStep& step, double newton, double bend, const Vec3& normal, double way,
                          double trust) const {
    const double length = std::min(newton, trust);
    if (length > 2.0 * way) {
        const Vec3 along = glm::normalize(step.slide);
        step.motion = step.drop + along * length - normal * (0.5 * bend * length * length);
        step.bent = true;
    }
}

// With the hand at depth d below a hill of radius R a flat step leaves d / R of the way. What the hill was
// seen to do on the last way it is believed to do on twice as much, and no edge or corner of it bends a step
// farther than the whole does.
void Proxy::follow_hill(ConstrainedStep& step, double newton, double way, Descent& descent) const {
    const double slide = glm::length(step.slide);
    descent.foreseen = std::max(1.2 * slide, newton);
    const double length = std::min({newton, 2.0 * way, descent.trust});
    if (length > 1.5 * slide) {
        step.motion = step.drop + step.slide * (length / slide);
        step.bent = true;
    }
}

// Coulomb: contacts hold the proxy along the surface with at most friction times what they hold it back
// across (unit: meters, as all forces over the stiffness). Every wall of a groove counts. What the proxy is
// still above does not hold it, unless it has only just slid off it: a surface that bends away is `dropped`
// below after a step along it.
double Proxy::friction_limit(const ConstrainedStep& step, double dropped) const {
    double limit = 0.0;
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts_[step.pressing[i]];
        const ScenePart& placed = scene_->parts()[contact.feature.part];
        const auto body = static_cast<int>(placed.body);
        const Feel feel = feel_at(*scene_, body, contact.feature);
        const bool at_rest = contact.gap <= 4.0 * tolerances().skin + dropped;
        double coefficient = friction_at(*feel.material, sliding_, slide_speed_);
        if (feel.friction()) {
            const double rest = settings_.radius + tolerances().skin;
            coefficient *= friction_share(*scene_, feel, body, contact.feature,
                                          position_ - contact.normal * (contact.gap + rest), contact.normal);
        }
        limit += at_rest ? coefficient * step.pressure[i] : 0.0;
    }
    return limit;
}

// After a tick in which the proxy has gone `way` on the surfaces of its last step (unit: meters).
void Proxy::heed_speed(const ConstrainedStep& step, const Vec3& way) {
    double fall = 0.0;  // of friction with the speed, p |mu'| (unit: seconds)
    Vec3 along = way;
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts_[step.pressing[i]];
        const ScenePart& placed = scene_->parts()[contact.feature.part];
        fall += step.pressure[i] *
                steepest_fall(*feel_at(*scene_, static_cast<int>(placed.body), contact.feature).material);
        along -= contact.normal * glm::dot(along, contact.normal);
    }
    if (fall <= 0.0) {
        slide_speed_ = 0.0;
        return;
    }
    const double speed = glm::length(along) / seconds_;
    slide_speed_ += (speed - slide_speed_) * (0.5 * seconds_ / std::max(fall, seconds_));
}

// What friction leaves of a step. It has no say in how far down the surface is. False where there is none.
bool Proxy::brake(ConstrainedStep& step, double dropped) {
    const double limit = friction_limit(step, dropped);
    const double slide = glm::length(step.slide);
    if (limit <= 0.0 || slide <= 0.0) {
        return limit > 0.0;
    }
    double left = std::max(0.0, slide - limit);
    if (left > tolerances().step && !sliding_) {
        sliding_ = true;  // static friction has given way: what is left is held by the dynamic one
        left = std::max(0.0, slide - friction_limit(step, dropped));
    }
    step.motion = step.drop + (step.motion - step.drop) * (left / slide);
    return true;
}

}  // namespace tactus
