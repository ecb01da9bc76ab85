#include "core/proxy/descent.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// What held the sphere a tick ago still does where it has gone no farther than that since (of the radius).
constexpr double least_way = 0.01;

// How far a step of that length along a surface may end above it: no surface bends more than the sphere
// itself does, and it rose by no more than `slope`.
double drop_after(double length, double slope, double radius) {
    return std::min(length * length / radius + slope * length, 0.1 * radius);
}

// The direction of a step along a surface is off by the rounding of the surface's place over the radius:
// 2^-53 of the largest coordinate, which is a 512th of the skin at most. Over more than 64 radii that makes
// an eighth of the skin or more, and what stops such a step at once would do so for ever.
bool strays(double length, double radius) {
    return length > 64.0 * radius;
}

}  // namespace

Descent::Descent(ProxySphere& sphere, ProxyHold& hold, const Vec3& hand, double given_way)
    : sphere_(sphere),
      hold_(hold),
      hand_(hand),
      start_(sphere.position),
      distance_(glm::distance(hand, sphere.position)),
      trust_(sphere.settings.radius, given_way) {}

DescentEnd Descent::go(double seconds) {
    hold_.crowd.begin_tick();
    if (!sphere_.contacts_hold) {  // what held it then may be what a search in a crowd does not find
        for (const Touch& touch : hold_.touching.all()) {
            sphere_.surroundings.mind().keep(touch.feature);
        }
    }
    go_on_through_crowd();
    for (; end_.steps < sphere_.settings.max_steps && !is_stuck_; ++end_.steps) {
        if (!plan_next()) {
            continue;
        }
        hold_back();
        if (end_.residual <= tolerances().step || is_last_) {
            break;
        }
        hold_.crowd.step_over(step_, pull_, sphere_, distance_);
        if (hold_.crowd.has_answered(step_, sphere_)) {
            break;
        }
        if (arrives()) {
            ++end_.steps;
            break;
        }
    }
    conclude(seconds);
    return end_;
}

void Descent::go_on_through_crowd() {
    Crowd& crowd = hold_.crowd;
    if (crowd.goes_on(sphere_, hand_ - sphere_.position)) {
        slid_ = true;
        const double slope = crowd.slope();
        beyond_ = drop_after(crowd.go_on(sphere_), slope, radius());
    }
}

// False where another round has to tell the next step: it was lifted, or too little was seen.
bool Descent::plan_next() {
    WorkBudget& work = sphere_.work();
    is_last_ = work.is_gone();
    if (is_last_) {
        recalls_ = false;
        work.open_reserve();
    }
    if (!sphere_.contacts_hold) {
        sphere_.contacts_hold = look_around();
    }
    if (lift()) {
        sphere_.contacts_hold = false;
        return false;
    }
    pull_ = hand_ - sphere_.position;
    plan();
    // Planned from less than there is, it says nothing: not that the end is reached either.
    is_known_ = !work.is_gone() && !is_cut_short_;
    if (!is_known_ && !is_last_) {
        sphere_.contacts_hold = sphere_.contacts_hold && !is_cut_short_;
        end_.residual = glm::length(pull_);
        return false;
    }
    if (recalls_ && is_end()) {
        recalls_ = false;
        return false;
    }
    return true;
}

// Out of what a moving body or the rounding of far coordinates let overlap, before anything slides along it.
// Friction has no say in that. False where there is nothing to lift: what a sweep has stopped at is half a
// skin below rest, and the next step rises by that much on its way. A step that strays needs all of the skin.
bool Descent::lift() {
    if (sphere_.contacts.min_gap() >= (strays_ ? -0.125 : -0.625) * tolerances().skin) {
        return false;
    }
    const Vec3 motion = lift_to_rest(sphere_.contacts, tolerances().same, sphere_.work());
    if (glm::length(motion) <= tolerances().step) {
        return false;
    }
    const Vec3 before = sphere_.position;
    FeatureId stopped_by;
    sphere_.advance(motion, stopped_by);
    return sphere_.position != before;
}

// What presses holds the sphere, and friction along it.
void Descent::hold_back() {
    if (step_.pressing_count > 0) {
        keep_touching();
        touched_ = true;
    }
    grips_ = hold_.friction.brake(step_, sphere_, dropped_);
    end_.residual = glm::length(is_known_ ? step_.motion : pull_);
}

void Descent::keep_touching() {
    hold_.touching.clear();
    const ContactLook look = sphere_.look();
    for (int i = 0; i < step_.pressing_count; ++i) {
        const Contact& contact = sphere_.contacts[step_.pressing[i]];
        // Where moving bodies squeeze the proxy it cannot get out of their way: what they overlap it by
        // presses, too.
        const double overlap = std::max(0.0, -contact.gap - tolerances().skin);
        look.describe(contact, step_.pressure[i] + overlap, hold_.touching.add());
    }
}

// Takes the step. Whether it has led to the hand, or to where the hand lets the sphere rest.
bool Descent::arrives() {
    const bool all_seen = sphere_.contacts_hold;
    const Vec3 from = sphere_.position;
    const Hit hit = take();
    if (hit.is_free() && step_.pressing_count == 0) {
        sphere_.position = hand_;  // to the bit: the way has led there
        end_.residual = 0.0;
        return true;
    }
    return hit.is_free() && all_seen && has_come_to_rest(from);
}

// Goes where the step leads, and keeps what that shows for the next one.
Hit Descent::take() {
    Surroundings& surroundings = sphere_.surroundings;
    const Crowd& crowd = hold_.crowd;
    const bool holds = step_.pressing_count > 0;
    slid_ = slid_ || (holds && step_.motion != step_.drop);
    const Vec3 before = sphere_.position;
    const double slope = crowd.slope();
    FeatureId stopped_by;
    const Hit hit = sweep(stopped_by);
    const double length = glm::distance(before, sphere_.position);
    // Where the work has ended before it moved, they are still those at its place.
    const bool is_stopper_known = hit.found || hit.triangle != Hit::no_triangle;
    sphere_.contacts_hold = length == 0.0 && !is_stopper_known && slope == crowd.slope() && !recalls_;
    const bool stopped_at_once = hit.found && length == 0.0;
    // How hard each contact presses, which friction goes by, only all of them tell.
    recalls_ = hit.found && length > 0.0 && holds && !grips_ && !crowd.is_around();
    strays_ = stopped_at_once && strays(glm::length(step_.motion), radius());
    if (is_stopper_known) {
        surroundings.mind().keep(stopped_by);
    } else if (!crowd.is_around()) {
        surroundings.mind().let_go();
    }
    beyond_ = drop_after(length, slope, radius());
    dropped_ = holds ? beyond_ : 0.0;
    trust_.taken(step_, pull_, length, hit.found);
    // Stopped at once by something that is no contact: it is one now.
    is_stuck_ = stopped_at_once && !surroundings.mind().insist_on(stopped_by, sphere_.position);
    return hit;
}

// Nothing is asked where the contacts tell already: a straight way that stays in front of their planes meets
// none of them, and one no longer than what is left out by them is above rest meets nothing else. Covered
// ones are asked as well: what stands for them does so at this place.
Hit Descent::sweep(FeatureId& stopped_by) {
    const double length = glm::length(step_.motion);
    if (sphere_.contacts_hold && length <= sphere_.surroundings.unseen_gap() &&
        stays_in_front_of_all(step_.motion, sphere_.contacts, tolerances().same)) {
        sphere_.position += step_.motion;
        sphere_.surroundings.travelled(length);
        return {};
    }
    return hold_.crowd.sweep(sphere_, step_, start_, stopped_by);
}

// What the tick leaves to the next one.
void Descent::conclude(double seconds) {
    end_.is_unfinished = end_.residual > tolerances().step;
    const Vec3 gone = sphere_.position - start_;
    const double way = glm::length(gone);
    Crowd& crowd = hold_.crowd;
    // Where the work has ended before what holds it was seen again, that still does; also what held it a tick
    // ago, where it is not far from there or steps over a crowd.
    const bool unseen = is_last_ && end_.is_unfinished;
    const bool is_held = touched_ || way <= least_way * radius() || crowd.is_around();
    if (step_.pressing_count == 0 && !(unseen && is_held)) {
        hold_.touching.clear();
    }
    crowd.end_tick(sphere_, way, hand_ - sphere_.position, end_.is_unfinished);
    SlideFriction& friction = hold_.friction;
    friction.set_sliding(friction.is_sliding() && slid_);
    friction.heed_speed(step_, sphere_, gone, seconds);
    end_.overlaps = sphere_.contacts_hold && sphere_.contacts.min_gap() < -tolerances().reach;
    end_.slide = step_.pressing_count > 0 ? step_.slide : Vec3(0.0);
}

}  // namespace tactus
