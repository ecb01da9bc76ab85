#include "core/haptics/proxy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "core/haptics/hand_place.hpp"

namespace tactus {

namespace {

// A proxy on a surface goes this many times as far as the hand at most: on a round one by 1 / (1 - depth / r)
// of it, where the hand is as deep as that below the bend's axis. What goes farther has slipped: off an edge
// that does not hold it, out of static friction, or on from where the work of the last tick had ended.
constexpr double max_sensitivity = 4.0;

// What throws the proxy farther than its radius, and than this, within a tick goes by faster than a hand can
// feel it come: its force fades in (unit: meters).
constexpr double max_ride = 0.01;

// No question of the surroundings takes more than a quarter of a tick's work, or than three usual ones; one
// that would is asked in another way (see step_over_crowd). Lengths of the radius.
constexpr std::int64_t least_question_share = 1'000;
constexpr double least_progress = 1e-3;
constexpr double crowd_reach = 1e-2;
constexpr double least_slope = 0.2;
constexpr double max_slope = 5.0;

}  // namespace

Proxy::Proxy(std::size_t max_parts, const ProxySettings& settings)
    : settings_(settings), surroundings_(max_parts) {}

void Proxy::put(const Vec3& place) {
    surroundings_.jumped(glm::distance(place, position_));
    position_ = place;
    contacts_hold_ = false;
}

void Proxy::go_along(const Vec3& offset, int body) {
    if (!sliding_) {
        displace(offset);
        return;
    }
    Vec3 pushed(0.0);
    std::array<Vec3, TouchList::capacity> across;  // the body's normals, made orthogonal
    int count = 0;
    for (const Touch& touch : touching()) {
        Vec3 normal = touch.body == body ? touch.normal : Vec3(0.0);
        for (int i = 0; i < count; ++i) {
            normal -=
                glm::dot(normal, across[static_cast<std::size_t>(i)]) * across[static_cast<std::size_t>(i)];
        }
        if (const double length = glm::length(normal); length > 1e-6) {
            normal /= length;
            across[static_cast<std::size_t>(count++)] = normal;
            pushed += glm::dot(offset, normal) * normal;
        }
    }
    displace(pushed);
}

// A proxy cannot start inside a surface: it appears where the hand is once there is room, so touch begins
// without a kick. Until then it is absent and follows the hand. A hand that starts by just touching has room
// enough: the first step lifts the sphere off by the thousandth of its radius that may be missing.
bool Proxy::appear() {
    const double room = settings_.radius * (1.0 - 1e-3);
    present_ = surroundings_.has_room(position_, room) &&
               !is_inside_one_sided(*scene_, position_, settings_.mask, surroundings_.work());
    contacts_hold_ = false;
    return present_;
}

// Straight on as far as the way is known to be free. A long way over a rough surface mostly ends early, and
// the bounds of a short one leave out far more: it is gone in strides, each as long as the last ones let it
// be.
Hit Proxy::advance(const Vec3& motion, FeatureId& stopped_by, int except) {
    const Vec3 origin = position_;
    const double length = glm::length(motion);
    Hit hit;
    double stride = surroundings_.first_stride();
    for (double gone = 0.0; gone < 1.0 && hit.is_free();) {
        const double share = stride / std::max(length, 1e-300);
        const double end = gone + share > 0.99 ? 1.0 : gone + share;
        hit = surroundings_.sweep(position_, motion * (end - gone), stopped_by, except);
        const double free_share = (end - gone) * (hit.is_free() ? 1.0 : hit.t);
        gone = hit.is_free() ? end : gone + free_share;
        stride = surroundings_.next_stride(free_share * length, hit.is_free());
        position_ = origin + motion * gone;
        surroundings_.travelled(free_share * length);
    }
    return hit;
}

void Proxy::keep_touching(const ConstrainedStep& step) {
    touching_.clear();
    const ContactLook look = surroundings_.look_from(position_);
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts_[step.pressing[i]];
        // Where moving bodies squeeze the proxy it cannot get out of their way: what they overlap it by
        // presses, too.
        const double overlap = std::max(0.0, -contact.gap - tolerances().skin);
        touching_.add(look.touch_of(contact, step.pressure[i] + overlap));
    }
}

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

// How far a step of that length along a surface may end above it: no surface bends more than the sphere
// itself does, and it rose by no more than `slope`.
double Proxy::drop_after(double length, double slope) const {
    return std::min(length * length / settings_.radius + slope * length, 0.1 * settings_.radius);
}

// Where nothing can be in the way, there is nothing to do.
bool Proxy::fly(const Vec3& hand) {
    const double way = glm::length(hand - position_);
    if (!surroundings_.is_clear(way)) {
        return false;
    }
    position_ = hand;
    surroundings_.travelled(way);
    sliding_ = false;
    slide_speed_ = 0.0;
    contacts_hold_ = false;
    return true;
}

std::int64_t Proxy::question_share() const {
    return std::max(settings_.max_work / 4, least_question_share);
}

// False where the work has ended before all was seen.
bool Proxy::look_around(Descent& descent) {
    WorkBudget& work = surroundings_.work();
    if (descent.slope == 0.0) {
        const WorkShare share(work, question_share());
        surroundings_.find_contacts(position_, contacts_, descent.beyond);
        descent.slope = share.is_too_small() ? least_slope : 0.0;
    }
    if (descent.slope > 0.0) {
        surroundings_.find_nearest_contacts(
            position_, std::max(descent.beyond, crowd_reach * settings_.radius), contacts_);
    }
    return descent.is_last || !work.is_gone();
}

// As far as that, by no more than a question's share of the work. Where that leads nowhere it is a crowd that
// stands in the way: the next step rises, and more steeply each time.
Hit Proxy::advance(const ConstrainedStep& step, Descent& descent, FeatureId& stopped_by) {
    const Vec3 before = position_;
    const WorkShare share(surroundings_.work(), question_share());
    const Hit hit = advance(step.motion, stopped_by);
    if (share.is_too_small() && !hit.complete &&
        glm::distance(before, position_) < least_progress * settings_.radius) {
        descent.slope = std::clamp(5.0 * descent.slope, least_slope, max_slope);
    }
    return hit;
}

void Proxy::descend(const Vec3& hand, ProxyTick& tick) {
    const Vec3 start = position_;
    Descent descent;
    descent.slope = crowd_slope_;
    ConstrainedStep step;
    WorkBudget& work = surroundings_.work();
    for (tick.steps = 0; tick.steps < settings_.max_steps; ++tick.steps) {
        descent.is_last = work.is_gone();
        if (descent.is_last) {
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
        step = plan(pull, descent);
        // Planned from less than there is, it says nothing: not that the end is reached either.
        const bool is_known = !work.is_gone();
        if (!is_known && !descent.is_last) {
            tick.residual = glm::length(pull);
            continue;
        }
        if (step.pressing_count > 0) {
            keep_touching(step);
            descent.touched = true;
        }
        brake(step, descent.dropped);
        tick.residual = glm::length(is_known ? step.motion : pull);
        if (tick.residual <= tolerances().step || descent.is_last) {
            break;
        }
        descent.slid = descent.slid || (step.pressing_count > 0 && step.motion != step.drop);
        step_over_crowd(step, pull, descent.slope);
        const Vec3 before = position_;
        const double slope = descent.slope;
        FeatureId stopped_by;
        const Hit hit = advance(step, descent, stopped_by);
        // Where the work has ended before it moved, they are still those at its place.
        contacts_hold_ = position_ == before && !hit.found && slope == descent.slope;
        const bool stopped_at_once = hit.found && position_ == before;
        descent.strays = stopped_at_once && strays(tick.residual);
        if (hit.found) {
            ++descent.stops;
            surroundings_.keep_in_mind(stopped_by);
        } else {
            surroundings_.clear_mind();
        }
        descent.beyond = drop_after(glm::distance(before, position_), slope);
        descent.dropped = step.pressing_count > 0 ? descent.beyond : 0.0;
        descent.last_bent = step.bent ? glm::distance(before, position_) : 0.0;
        if (hit.is_free() && step.pressing_count == 0) {
            position_ = hand;
            ++tick.steps;
            tick.residual = 0.0;
            break;
        }
        // Stopped at once by something that is no contact: it is one now.
        if (stopped_at_once && !surroundings_.insist_on(stopped_by, position_)) {
            break;
        }
    }
    const bool is_held = tick.residual > tolerances().step &&
                         glm::distance(position_, start) < least_progress * settings_.radius;
    crowd_slope_ = is_held ? descent.slope : 0.0;
    sliding_ = sliding_ && descent.slid;
    heed_speed(step, position_ - start);
    overlaps_ = contacts_hold_ && contacts_.min_gap() < -tolerances().reach;
    // Where the work has ended before what holds it was seen again, that still does; also what held it a tick
    // ago, where it is not far from there or steps over a crowd.
    const bool unseen = descent.is_last && tick.residual > tolerances().step;
    const bool is_near = glm::distance(position_, start) <= 0.01 * settings_.radius;
    if (step.pressing_count == 0 && !(unseen && (descent.touched || is_near || descent.slope > 0.0))) {
        touching_.clear();
    }
    tick.slide = step.pressing_count > 0 ? step.slide : Vec3(0.0);
    if (tick.residual > tolerances().step) {
        tick.status |= proxy_unfinished;
    }
}

// Up to the hand, or as near as the surfaces let it. `given_way`: of the hand and of what carries the proxy
// since the last tick (unit: meters). `changed`: what it touched then may not be there any more.
void Proxy::follow(const Vec3& hand, double given_way, bool changed, ProxyTick& tick) {
    const Vec3 start = position_;
    const bool overlapped = std::exchange(overlaps_, false);
    const bool touched = touching_.count > 0;
    if (changed) {
        touching_.clear();
    }
    if (fly(hand)) {
        touching_.clear();
    } else {
        descend(hand, tick);
    }
    const bool touches = touching_.count > 0;
    const bool slipped = (touched || touches) &&
                         glm::distance(position_, start) > max_sensitivity * given_way + tolerances().reach;
    tick.jumped = tick.jumped || slipped || overlapped || overlaps_;
    const PassedBodies& passed = surroundings_.passed();
    const bool lets_out_of_squeeze = passed.any(PassedBecause::squeezes);
    const auto say = [&](ProxyStatus status, bool holds) { tick.status |= holds ? status : 0u; };
    say(proxy_touching, touches);
    say(proxy_sliding, sliding_);
    say(proxy_squeezed, overlaps_ || lets_out_of_squeeze);
    say(proxy_letting_out, lets_out_of_squeeze || passed.any(PassedBecause::overlaps));
}

ProxyTick Proxy::move(const TouchScene& scene, const Vec3& given_hand, double seconds) {
    ProxyTick tick;
    scene_ = &scene;
    seconds_ = seconds;
    const Vec3 hand_before = std::exchange(hand_, is_hand_place(given_hand) ? given_hand : hand_);
    if (!present_) {
        put(hand_);
    }
    const bool changed = surroundings_.begin_tick(scene, position_, settings_.radius, settings_.mask,
                                                  WorkBudget(settings_.max_work, settings_.max_work / 8));
    contacts_hold_ = contacts_hold_ && !changed;
    const bool was_present = present_;
    const Vec3 before = position_;
    tick.jumped = take_in_jumps();
    if (present_) {
        ride_along(tick);
    }
    const double ridden = glm::distance(position_, before);
    tick.jumped = tick.jumped || ridden > std::max(max_ride, settings_.radius);
    const double given_way = glm::distance(hand_, hand_before) + ridden;
    if (was_present && !present_) {
        put(hand_);
        tick.jumped = true;
    }
    const bool appears = !present_ && appear();
    if (present_) {
        follow(hand_, given_way, changed, tick);
    }
    // The work may have ended before it was lifted out of what it begins too deep in: it begins later, then.
    const bool is_deep = contacts_.min_gap() < -tolerances().skin || !surroundings_.saw_all();
    if (appears && contacts_hold_ && is_deep) {
        restart();
        put(hand_);
        tick = {};
    }
    if (!present_) {
        touching_.clear();
        tick.status |= proxy_absent;
    }
    tick.position = position_;
    return tick;
}

}  // namespace tactus
