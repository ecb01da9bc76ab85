#include "core/haptics/proxy.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace tactus {

namespace {

// A proxy on a surface goes this many times as far as the hand at most: on a round one by 1 / (1 - depth / r)
// of it, where the hand is as deep as that below the bend's axis. What goes farther has slipped: off an edge
// that does not hold it, out of static friction, or on from where the work of the last tick had ended.
constexpr double max_sensitivity = 4.0;

}  // namespace

Proxy::Proxy(std::size_t max_parts, const ProxySettings& settings)
    : settings_(settings), surroundings_(max_parts) {}

void Proxy::put(const Vec3& place) {
    surroundings_.jumped(glm::distance(place, position_));
    position_ = place;
    contacts_hold_ = false;
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

// Coulomb: contacts hold the proxy along the surface with at most friction times what they hold it back
// across (unit: meters, as all forces over the stiffness). Every wall of a groove counts. What the proxy is
// still above does not hold it, unless it has only just slid off it: a surface that bends away is `dropped`
// below after a step along it.
double Proxy::friction_limit(const ConstrainedStep& step, double dropped) const {
    double limit = 0.0;
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts_[step.pressing[i]];
        const ScenePart& placed = scene_->parts()[contact.feature.part];
        const TouchMaterial& material = scene_->body(static_cast<int>(placed.body)).material;
        const bool at_rest = contact.gap <= 4.0 * tolerances().skin + dropped;
        const double coefficient = sliding_ ? material.dynamic_friction : material.static_friction;
        limit += at_rest ? coefficient * step.pressure[i] : 0.0;
    }
    return limit;
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
// skin below rest, and the next step rises by that much on its way.
bool Proxy::lift() {
    if (contacts_.min_gap() >= -0.625 * tolerances().skin) {
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

// What friction leaves of a step. It has no say in how far down the surface is.
void Proxy::brake(ConstrainedStep& step, double dropped) {
    const double limit = friction_limit(step, dropped);
    const double slide = glm::length(step.slide);
    if (limit <= 0.0 || slide <= 0.0) {
        return;
    }
    double left = std::max(0.0, slide - limit);
    if (left > tolerances().step && !sliding_) {
        sliding_ = true;  // static friction has given way: what is left is held by the dynamic one
        left = std::max(0.0, slide - friction_limit(step, dropped));
    }
    step.motion = step.drop + (step.motion - step.drop) * (left / slide);
}

// How far a step of that length along a surface may end above it: no surface bends more than the sphere
// itself does.
double Proxy::drop_after(double length) const {
    return std::min(length * length / settings_.radius, 0.1 * settings_.radius);
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
    contacts_hold_ = false;
    return true;
}

// The step towards the hand over what is known of the contacts. Those that hold it back are looked at closely
// first; what that changes may let others press.
ConstrainedStep Proxy::plan(const Vec3& pull, Descent& descent) {
    WorkBudget& work = surroundings_.work();
    const ContactLook look = surroundings_.look_from(position_);
    const double length = glm::length(pull);
    ConstrainedStep step;
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
    if (step.pressing_count == 0) {
        return step;
    }
    doubt(step, pull, descent);
    if (is_flat || step.pressing_count == TouchList::capacity) {
        return step;
    }
    const auto curvature = [&](int i) {
        return i < step.pressing_count ? look.curvature_of(contacts_, step.pressing[i]) : Curvature{};
    };
    const Curvature curvatures[] = {curvature(0), curvature(1)};
    bend_step(step, pull, contacts_, {curvatures, static_cast<std::size_t>(step.pressing_count)},
              tolerances().same, descent.trust);
    return step;
}

// Flat steps never lead away from the hand, bent ones may, and several may lead around in a circle. What
// counts is how far from the hand the proxy is once it has dropped onto what holds it back: where a step has
// won nothing, bent ones are trusted half as far as it went, and twice as far again where one has.
void Proxy::doubt(const ConstrainedStep& step, const Vec3& pull, Descent& descent) const {
    const double distance = glm::distance(pull, step.drop);
    if (distance < descent.nearest - tolerances().same) {
        descent.nearest = distance;
        descent.trust *= 2.0;
    } else if (descent.last_bent > 0.0) {
        descent.trust = 0.5 * descent.last_bent;
    }
}

void Proxy::descend(const Vec3& hand, ProxyTick& tick) {
    Descent descent;
    ConstrainedStep step;
    WorkBudget& work = surroundings_.work();
    for (tick.steps = 0; tick.steps < settings_.max_steps; ++tick.steps) {
        const bool is_last = work.is_gone();
        if (is_last) {
            work.open_reserve();
        }
        if (!contacts_hold_) {
            surroundings_.find_contacts(position_, contacts_, descent.beyond);
            contacts_hold_ = true;
        }
        if (!is_last && lift()) {
            contacts_hold_ = false;
            continue;
        }
        const Vec3 pull = hand - position_;
        step = plan(pull, descent);
        brake(step, descent.dropped);
        tick.residual = glm::length(step.motion);
        if (tick.residual <= tolerances().step || is_last) {
            break;
        }
        descent.slid = descent.slid || (step.pressing_count > 0 && step.motion != step.drop);
        const Vec3 before = position_;
        FeatureId stopped_by;
        const Hit hit = advance(step.motion, stopped_by);
        contacts_hold_ = false;
        if (hit.found) {
            surroundings_.keep_in_mind(stopped_by);
        } else {
            surroundings_.clear_mind();
        }
        descent.beyond = drop_after(glm::distance(before, position_));
        descent.dropped = step.pressing_count > 0 ? descent.beyond : 0.0;
        descent.last_bent = step.bent ? glm::distance(before, position_) : 0.0;
        if (hit.is_free() && step.pressing_count == 0) {
            position_ = hand;
            ++tick.steps;
            tick.residual = 0.0;
            break;
        }
        // Stopped at once by something that is no contact: it is one now.
        if (hit.found && position_ == before && !surroundings_.insist_on(stopped_by, position_)) {
            break;
        }
    }
    sliding_ = sliding_ && descent.slid;
    overlaps_ = contacts_hold_ && contacts_.min_gap() < -tolerances().reach;
    keep_touching(step);
    tick.slide = step.pressing_count > 0 ? step.slide : Vec3(0.0);
    if (tick.residual > tolerances().step) {
        tick.status |= proxy_unfinished;
    }
}

// Up to the hand, or as near as the surfaces let it. `given_way`: of the hand and of what carries the proxy
// since the last tick (unit: meters).
void Proxy::follow(const Vec3& hand, double given_way, ProxyTick& tick) {
    const Vec3 start = position_;
    const bool overlapped = std::exchange(overlaps_, false);
    const bool touched = touching_.count > 0;
    touching_.clear();
    if (!fly(hand)) {
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

ProxyTick Proxy::move(const TouchScene& scene, const Vec3& given_hand) {
    ProxyTick tick;
    scene_ = &scene;
    // Devices do send numbers that are none: the hand stays where it was last.
    constexpr double farthest = 1e9;
    const Vec3 size = glm::abs(given_hand);
    const bool is_place = size.x <= farthest && size.y <= farthest && size.z <= farthest;
    const Vec3 hand_before = std::exchange(hand_, is_place ? given_hand : hand_);
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
    const double given_way = glm::distance(hand_, hand_before) + glm::distance(position_, before);
    if (was_present && !present_) {
        put(hand_);
        tick.jumped = true;
    }
    if (present_ || appear()) {
        follow(hand_, given_way, tick);
    } else {
        touching_.clear();
        tick.status |= proxy_absent;
    }
    tick.position = position_;
    return tick;
}

}  // namespace tactus
