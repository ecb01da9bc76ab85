#include "core/proxy/crowd.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// A sweep in a crowd that takes less than an eighth of a question's share shows that it is left.
constexpr std::int64_t share_out_of_crowd = 8;
// A sweep that takes its whole share and leads less far than that is held by a crowd (of the radius).
constexpr double least_progress = 1e-3;
// A tick in a crowd that leads less far than that leaves the next one in it, to rise more steeply (of the
// radius).
constexpr double least_progress_of_tick = 1e-2;
// A crowd whose boxes are thinner than t is behind a step of slope s from the angle s off the touching place
// on, where the sphere is s^2 r / 2 above it: 0.2 leaves out what is rough up to 2 % of the radius. The third
// step over one that is rougher, or all around, goes nearly straight up.
constexpr double least_slope = 0.2;
constexpr double max_slope = 5.0;
constexpr double steeper = 5.0;
// A step over a crowd may end that much farther from the hand than its tick began (of the radius).
constexpr double max_detour = 0.1;
// A held step is asked to its end as long as the hand leads about where it did (of the way to it).
constexpr double same_pull = 0.25;

// Of a way that begins in a ball around `center`, as far as it stays in it.
double share_within(const Vec3& way, const Vec3& center, double radius) {
    const double squared = glm::dot(way, way);
    const double inwards = glm::dot(way, center);
    const double room = std::max(0.0, radius * radius - glm::dot(center, center));
    const double farthest = inwards + std::sqrt(inwards * inwards + squared * room);
    return farthest < squared ? farthest / squared : 1.0;
}

}  // namespace

void Crowd::recall(const CrowdHold& hold) {
    hold_ = hold;
    if (hold_.next == CrowdHold::Next::on) {
        hold_.next = CrowdHold::Next::anew;
    }
}

void Crowd::enter() {
    hold_.slope = std::max(hold_.slope, least_slope);
}

// To slide along a crowd each of its triangles has to be looked at. A sphere that is clear of everything is
// clear of all that lies behind it wherever it goes: where it rises on its way above all that is known of the
// crowd, the rest is behind. It drops in a later step. What stands for a crowd does not tell how far it may
// slide: around a seat of thousands of facets such a step would lead out over its rim. So it ends no farther
// from the hand than the tick began, but for a little.
void Crowd::step_over(ConstrainedStep& step, const Vec3& pull, ProxySphere& sphere, double distance) const {
    const double rise = hold_.slope * glm::distance(step.motion, step.drop);
    // What nothing holds back goes to the hand, and nowhere else.
    if (rise <= 0.0 || step.pressing_count == 0) {
        return;
    }
    // Friction and bends have led it elsewhere than the hand.
    const Vec3 goal = pull + (step.motion - step.drop - step.slide);
    ContactList& contacts = sphere.contacts;
    std::array<double, ContactList::capacity> gaps;
    for (int i = 0; i < contacts.count; ++i) {
        gaps[static_cast<std::size_t>(i)] = contacts[i].gap;
        contacts[i].gap -= rise;
    }
    step.motion = flat_step(goal, contacts, sphere.tolerances().same, sphere.work()).motion;
    for (int i = 0; i < contacts.count; ++i) {
        contacts[i].gap = gaps[static_cast<std::size_t>(i)];
    }
    step.motion *= share_within(step.motion, pull, distance + max_detour * sphere.settings.radius);
}

// Whether a crowd has held this very step.
bool Crowd::is_asked_again(const ConstrainedStep& step, const ProxySphere& sphere) const {
    return is_around() && sphere.position == hold_.place &&
           glm::distance(step.motion, hold_.step) <= sphere.tolerances().step;
}

// By no more than a question's share of the work, or where that was not enough before, by all that is left.
// Where it leads nowhere it is a crowd that stands in the way: the next step rises, and more steeply each
// time. So it does where it is stopped by what a full list of contacts leaves out, or where half of the work
// has led nowhere. A step that takes little again has left the crowd.
Hit Crowd::sweep(ProxySphere& sphere, const ConstrainedStep& step, const Vec3& start, FeatureId& stopped_by) {
    WorkBudget& work = sphere.work();
    const std::int64_t max_work = sphere.settings.max_work;
    const Vec3 before = sphere.position;
    const std::int64_t left = work.left();
    const bool is_again = is_asked_again(step, sphere);
    const std::int64_t given = is_again ? left : std::min(left, question_share(max_work));
    const WorkShare share(work, given);
    const Hit hit = sphere.advance(step.motion, stopped_by);
    const bool is_used_up = is_again ? work.is_gone() : share.is_too_small();
    const auto leads_nowhere_from = [&](const Vec3& place) {
        return glm::distance(place, sphere.position) < least_progress * sphere.settings.radius;
    };
    if (is_used_up && !hit.complete && leads_nowhere_from(before)) {
        hold_ = {std::clamp(steeper * hold_.slope, least_slope, max_slope), sphere.position, step.motion};
        long_sweep_ = {stopped_by.part};
    } else if (hit.is_free()) {
        const bool is_left = given - work.left() < question_share(max_work) / share_out_of_crowd;
        hold_.slope = is_left ? 0.0 : hold_.slope;
    } else if ((sphere.contacts.is_full() && step.pressing_count > 0 && leads_nowhere_from(before)) ||
               (2 * (left - given) < max_work && leads_nowhere_from(start))) {
        enter();
    }
    return hit;
}

// Where even the steepest steps are held, the last of them is asked to its end, however many ticks that
// takes: as long as the sphere and all around it stay where they are, and the hand leads about where it did.
bool Crowd::leads_on(const ProxySphere& sphere, const Vec3& pull) {
    const bool holds = sphere.position == hold_.place &&
                       glm::distance(pull, hold_.pull) <= same_pull * glm::length(hold_.pull);
    if (!holds) {
        leave();
    }
    return holds;
}

// Around a throat of the sphere's own size no bound tells thousands of triangles apart, and a step of one
// radius and one of a hundredth take the same work: so it is asked whole.
double Crowd::go_on(ProxySphere& sphere) {
    FeatureId stopped_by;
    const Hit hit = sphere.surroundings.sweep_on(sphere.position, hold_.step, long_sweep_, stopped_by);
    if (!long_sweep_.is_done) {
        return 0.0;
    }
    const double way = hit.t * glm::length(hold_.step);
    sphere.position += hit.t * hold_.step;
    sphere.surroundings.travelled(way);
    sphere.contacts_hold = false;
    if (!hit.found || way >= least_progress * sphere.settings.radius) {
        leave();
        return way;
    }
    hold_.next = CrowdHold::Next::no_more;
    sphere.surroundings.mind().keep(stopped_by);
    sphere.surroundings.mind().insist_on(stopped_by, sphere.position);
    return way;
}

void Crowd::end_tick(const ProxySphere& sphere, double way, const Vec3& pull, bool is_unfinished) {
    if (way >= least_progress_of_tick * sphere.settings.radius) {
        return leave();
    }
    if (!is_unfinished || hold_.next != CrowdHold::Next::anew) {
        return;
    }
    if (slope_before_ >= max_slope) {
        hold_.next = CrowdHold::Next::on;
        hold_.pull = pull;
    } else {
        hold_.slope = std::min(max_slope, steeper * hold_.slope);
    }
}

}  // namespace tactus
