// The steps of one tick: look around, plan, go, until nothing is left to go or to spend.
#include <algorithm>
#include <glm/geometric.hpp>

#include "core/haptics/proxy.hpp"

namespace tactus {

namespace {

// Of the radius. Where the hand rests, bent steps are still of use.
constexpr double least_trust = 1e-6;
// What stands for a crowd is looked for up to here above rest (of the radius).
constexpr double crowd_reach = 1e-2;
// Where a step of this tick was stopped by what was no contact, the few nearest ones up to that much farther
// (of the radius) are contacts as well: the next steps are planned with them instead of ending there.
constexpr double look_ahead = 1e-3;
// Not where there are more contacts than that: to tell those ahead apart takes more than the stops they save.
constexpr int max_sparse = 16;

}  // namespace

// Out of what a moving body or the rounding of far coordinates let overlap, before anything slides along it.
// Friction has no say in that. False where there is nothing to lift: what a sweep has stopped at is half a
// skin below rest, and the next step rises by that much on its way. A step that strays needs all of the skin.
bool Proxy::lift(bool strays) {
    if (contacts_.min_gap() >= (strays ? -0.125 : -0.625) * tolerances().skin) {
        return false;
    }
    const Vec3 motion = lift_to_rest(contacts_, tolerances().same, surroundings_.work());
    if (glm::length(motion) <= tolerances().step) {
        return false;
    }
    const Vec3 before = position_;
    FeatureId stopped_by;
    advance(motion, stopped_by);
    return position_ != before;
}

// The direction of a step along a surface is off by the rounding of the surface's place over the radius:
// 2^-53 of the largest coordinate, which is a 512th of the skin at most. Over more than 64 radii that makes
// an eighth of the skin or more, and what stops such a step at once would do so for ever.
bool Proxy::strays(double length) const {
    return length > 64.0 * settings_.radius;
}

// Nothing holds it back, or nothing is left to go.
bool Proxy::is_end(const ConstrainedStep& step) const {
    return step.pressing_count == 0 || glm::length(step.motion) <= tolerances().step;
}

// How far a step of that length along a surface may end above it: no surface bends more than the sphere
// itself does, and it rose by no more than `slope`.
double Proxy::drop_after(double length, double slope) const {
    return std::min(length * length / settings_.radius + slope * length, 0.1 * settings_.radius);
}

// What a step is planned over. False where that is not all there is: the work has ended before, or it is only
// what is in mind. That does for most steps over fine facets, which the next one stops: the contacts that
// pressed and the one that stopped it. Where nothing is left to go over them, nothing is over all of them; so
// the end of the way is asked of all, and what a step over some does not know of stops its sweep.
bool Proxy::look_around(Descent& descent) {
    WorkBudget& work = surroundings_.work();
    const double ahead = descent.stops > 0 && !descent.is_dense ? look_ahead * settings_.radius : 0.0;
    if (descent.recalls) {
        surroundings_.recall_contacts(position_, contacts_, descent.beyond + ahead);
        return false;
    }
    if (descent.crowd.slope == 0.0) {
        const WorkShare share(work, question_share());
        surroundings_.find_contacts(position_, contacts_, descent.beyond, ahead);
        if (share.is_too_small()) {
            enter_crowd(descent);
        }
        descent.is_dense = contacts_.count > max_sparse;
    }
    if (descent.crowd.slope > 0.0) {
        surroundings_.find_nearest_contacts(
            position_, std::max(descent.beyond, crowd_reach * settings_.radius), contacts_);
    }
    return descent.is_last || !work.is_gone();
}

// Nothing is asked where the contacts tell already: a straight way that stays in front of their planes meets
// none of them, and one no longer than what is left out by them is above rest meets nothing else. Covered
// ones are asked as well: what stands for them does so at this place.
Hit Proxy::advance(const ConstrainedStep& step, Descent& descent, FeatureId& stopped_by) {
    const double length = glm::length(step.motion);
    if (contacts_hold_ && length <= surroundings_.unseen_gap() &&
        stays_in_front_of_all(step.motion, contacts_, tolerances().same)) {
        position_ += step.motion;
        surroundings_.travelled(length);
        return {};
    }
    return sweep_in_share(step, descent, stopped_by);
}

// Goes where the step leads, and keeps what that shows for the next one.
Hit Proxy::take(ConstrainedStep& step, const Vec3& pull, Descent& descent) {
    const bool holds = step.pressing_count > 0;
    descent.slid = descent.slid || (holds && step.motion != step.drop);
    const Vec3 before = position_;
    const double slope = descent.crowd.slope;
    FeatureId stopped_by;
    const Hit hit = advance(step, descent, stopped_by);
    const double length = glm::distance(before, position_);
    // Where the work has ended before it moved, they are still those at its place.
    const bool is_stopper_known = hit.found || hit.triangle != Hit::no_triangle;
    contacts_hold_ = length == 0.0 && !is_stopper_known && slope == descent.crowd.slope && !descent.recalls;
    const bool stopped_at_once = hit.found && length == 0.0;
    // How hard each contact presses, which friction goes by, only all of them tell.
    descent.recalls = hit.found && length > 0.0 && holds && !descent.grips && descent.crowd.slope == 0.0;
    descent.strays = stopped_at_once && strays(glm::length(step.motion));
    descent.was_stopped = hit.found;
    descent.stops += hit.found;
    if (is_stopper_known) {
        surroundings_.keep_in_mind(stopped_by);
    } else if (descent.crowd.slope == 0.0) {
        surroundings_.clear_mind();
    }
    descent.beyond = drop_after(length, slope);
    descent.dropped = holds ? descent.beyond : 0.0;
    descent.last_bent =
        step.bent ? BentStep{length, glm::length(step.slide), glm::distance(pull, step.drop)} : BentStep{};
    // Stopped at once by something that is no contact: it is one now.
    descent.is_stuck = stopped_at_once && !surroundings_.insist_on(stopped_by, position_);
    return hit;
}

// A bent step is believed in at first as far as a proxy follows its hand.
void Proxy::descend(const Vec3& hand, double given_way, ProxyTick& tick) {
    Descent descent;
    descent.crowd = crowd_;
    descent.start = position_;
    descent.distance = glm::distance(hand, position_);
    if (!contacts_hold_) {  // what held it then may be what a search in a crowd does not find
        for (const Touch& touch : touching()) {
            surroundings_.keep_in_mind(touch.feature);
        }
    }
    descent.trust = std::max(max_sensitivity * given_way, least_trust * settings_.radius);
    ConstrainedStep step;
    WorkBudget& work = surroundings_.work();
    if (descent.crowd.next == CrowdHold::Next::on) {
        go_on(hand - position_, descent);
    }
    for (tick.steps = 0; tick.steps < settings_.max_steps && !descent.is_stuck; ++tick.steps) {
        descent.is_last = work.is_gone();
        if (descent.is_last) {
            descent.recalls = false;
            work.open_reserve();
        }
        if (!contacts_hold_) {
            contacts_hold_ = look_around(descent);
        }
        if (lift(descent.strays)) {
            contacts_hold_ = false;
            continue;
        }
        const Vec3 pull = hand - position_;
        step = plan_in_share(pull, descent);
        // Planned from less than there is, it says nothing: not that the end is reached either.
        const bool is_known = !work.is_gone() && !descent.is_cut_short;
        if (!is_known && !descent.is_last) {
            contacts_hold_ = contacts_hold_ && !descent.is_cut_short;
            tick.residual = glm::length(pull);
            continue;
        }
        if (descent.recalls && is_end(step)) {
            descent.recalls = false;
            continue;
        }
        if (step.pressing_count > 0) {
            keep_touching(step);
            descent.touched = true;
        }
        descent.grips = brake(step, descent.dropped);
        tick.residual = glm::length(is_known ? step.motion : pull);
        if (tick.residual <= tolerances().step || descent.is_last) {
            break;
        }
        step_over_crowd(step, pull, descent);
        if (descent.crowd.next == CrowdHold::Next::no_more && is_asked_again(step, descent.crowd)) {
            break;
        }
        const bool all_seen = contacts_hold_;
        const Vec3 from = position_;
        const Hit hit = take(step, pull, descent);
        if (hit.is_free() && step.pressing_count == 0) {
            position_ = hand;  // to the bit: the way has led there
            ++tick.steps;
            tick.residual = 0.0;
            break;
        }
        if (hit.is_free() && all_seen && has_come_to_rest(step, from, hand, descent, tick)) {
            ++tick.steps;
            break;
        }
    }
    conclude(step, descent, tick);
}

// What the tick leaves to the next one, and says.
void Proxy::conclude(const ConstrainedStep& step, const Descent& descent, ProxyTick& tick) {
    const bool is_unfinished = tick.residual > tolerances().step;
    const double way = glm::distance(position_, descent.start);
    keep_crowd(descent, way, is_unfinished);
    sliding_ = sliding_ && descent.slid;
    heed_speed(step, position_ - descent.start);
    overlaps_ = contacts_hold_ && contacts_.min_gap() < -tolerances().reach;
    // Where the work has ended before what holds it was seen again, that still does; also what held it a tick
    // ago, where it is not far from there or steps over a crowd.
    const bool unseen = descent.is_last && is_unfinished;
    const bool is_near = way <= 0.01 * settings_.radius;
    if (step.pressing_count == 0 && !(unseen && (descent.touched || is_near || descent.crowd.slope > 0.0))) {
        touching_.clear();
    }
    tick.slide = step.pressing_count > 0 ? step.slide : Vec3(0.0);
    if (is_unfinished) {
        tick.status |= proxy_unfinished;
    }
}

}  // namespace tactus
