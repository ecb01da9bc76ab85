// Crowds: where thousands of triangles are about as near as the one that is touched, so that to ask for all
// of them takes longer than a tick.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/proxy.hpp"

namespace tactus {

namespace {

// No question of the surroundings takes more than a quarter of a tick's work, or than three usual ones take:
// one that would is asked in another way.
constexpr std::int64_t least_question_share = 1'000;
// A sweep in a crowd that takes less than an eighth of that share shows that it is left.
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

std::int64_t Proxy::question_share() const {
    return std::max(settings_.max_work / 4, least_question_share);
}

void Proxy::enter_crowd(Descent& descent) const {
    descent.crowd.slope = std::max(descent.crowd.slope, least_slope);
}

// Where it takes more than a question's share to tell which contacts hold it back, they are a crowd as well.
ConstrainedStep Proxy::plan_in_share(const Vec3& pull, Descent& descent) {
    const WorkShare share(surroundings_.work(), question_share());
    const ConstrainedStep step = plan(pull, descent);
    descent.is_cut_short = share.is_too_small();
    if (descent.is_cut_short) {
        enter_crowd(descent);
    }
    return step;
}

// To slide along a crowd each of its triangles has to be looked at. A sphere that is clear of everything is
// clear of all that lies behind it wherever it goes: where it rises on its way above all that is known of the
// crowd, the rest is behind. It drops in a later step. What stands for a crowd does not tell how far it may
// slide: around a seat of thousands of facets such a step would lead out over its rim. So it ends no farther
// from the hand than the tick began, but for a little.
void Proxy::step_over_crowd(ConstrainedStep& step, const Vec3& pull, const Descent& descent) {
    const double rise = descent.crowd.slope * glm::distance(step.motion, step.drop);
    // What nothing holds back goes to the hand, and nowhere else.
    if (rise <= 0.0 || step.pressing_count == 0) {
        return;
    }
    // Friction and bends have led it elsewhere than the hand.
    const Vec3 goal = pull + (step.motion - step.drop - step.slide);
    std::array<double, ContactList::capacity> gaps;
    for (int i = 0; i < contacts_.count; ++i) {
        gaps[static_cast<std::size_t>(i)] = contacts_[i].gap;
        contacts_[i].gap -= rise;
    }
    step.motion = flat_step(goal, contacts_, tolerances().same, surroundings_.work()).motion;
    for (int i = 0; i < contacts_.count; ++i) {
        contacts_[i].gap = gaps[static_cast<std::size_t>(i)];
    }
    step.motion *= share_within(step.motion, pull, descent.distance + max_detour * settings_.radius);
}

// Whether a crowd has held this very step.
bool Proxy::is_asked_again(const ConstrainedStep& step, const CrowdHold& crowd) const {
    return crowd.slope > 0.0 && position_ == crowd.place &&
           glm::distance(step.motion, crowd.step) <= tolerances().step;
}

// As far as that, by no more than a question's share of the work, or where that was not enough before, by all
// that is left. Where it leads nowhere it is a crowd that stands in the way: the next step rises, and more
// steeply each time. So it does where it is stopped by what a full list of contacts leaves out, or where half
// of the work has led nowhere. A step that takes little again has left the crowd.
Hit Proxy::sweep_in_share(const ConstrainedStep& step, Descent& descent, FeatureId& stopped_by) {
    WorkBudget& work = surroundings_.work();
    const Vec3 before = position_;
    const std::int64_t left = work.left();
    const bool is_again = is_asked_again(step, descent.crowd);
    const std::int64_t given = is_again ? left : std::min(left, question_share());
    const WorkShare share(work, given);
    const Hit hit = advance(step.motion, stopped_by);
    const bool is_used_up = is_again ? work.is_gone() : share.is_too_small();
    const auto leads_nowhere_from = [&](const Vec3& place) {
        return glm::distance(place, position_) < least_progress * settings_.radius;
    };
    if (is_used_up && !hit.complete && leads_nowhere_from(before)) {
        descent.crowd = {std::clamp(steeper * descent.crowd.slope, least_slope, max_slope), position_,
                         step.motion};
        long_sweep_ = {stopped_by.part};
    } else if (hit.is_free()) {
        const bool is_left = given - work.left() < question_share() / share_out_of_crowd;
        descent.crowd.slope = is_left ? 0.0 : descent.crowd.slope;
    } else if ((contacts_.is_full() && step.pressing_count > 0 && leads_nowhere_from(before)) ||
               (2 * (left - given) < settings_.max_work && leads_nowhere_from(descent.start))) {
        enter_crowd(descent);
    }
    return hit;
}

// Where even the steepest steps are held, the last of them is asked to its end, however many ticks that
// takes: as long as the sphere and all around it stay where they are, and the hand leads about where it did.
// Around a throat of the sphere's own size no bound tells thousands of triangles apart, and a step of one
// radius and one of a hundredth take the same work: so it is asked whole.
void Proxy::go_on(const Vec3& pull, Descent& descent) {
    CrowdHold& crowd = descent.crowd;
    if (position_ != crowd.place || glm::distance(pull, crowd.pull) > same_pull * glm::length(crowd.pull)) {
        crowd = {};
        return;
    }
    descent.slid = true;
    FeatureId stopped_by;
    const Hit hit = surroundings_.sweep_on(position_, crowd.step, long_sweep_, stopped_by);
    if (!long_sweep_.is_done) {
        return;
    }
    const double way = hit.t * glm::length(crowd.step);
    position_ += hit.t * crowd.step;
    surroundings_.travelled(way);
    contacts_hold_ = false;
    descent.beyond = drop_after(way, crowd.slope);
    if (!hit.found || way >= least_progress * settings_.radius) {
        crowd = {};
        return;
    }
    crowd.next = CrowdHold::Next::no_more;
    surroundings_.keep_in_mind(stopped_by);
    surroundings_.insist_on(stopped_by, position_);
}

// What the next tick begins with.
void Proxy::keep_crowd(const Descent& descent, double way, bool is_unfinished) {
    const bool was_steepest = crowd_.slope >= max_slope;
    crowd_ = way < least_progress_of_tick * settings_.radius ? descent.crowd : CrowdHold{};
    if (!is_unfinished || crowd_.next != CrowdHold::Next::anew) {
        return;
    }
    if (was_steepest) {
        crowd_.next = CrowdHold::Next::on;
        crowd_.pull = hand_ - position_;
    } else {
        crowd_.slope = std::min(max_slope, steeper * crowd_.slope);
    }
}

}  // namespace tactus
