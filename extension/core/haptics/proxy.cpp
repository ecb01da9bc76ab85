#include "core/haptics/proxy.hpp"

#include "core/haptics/deform_ride.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace tactus {

namespace {

// No stride of a way is shorter than this share of the radius.
constexpr double least_stride = 0.02;

}  // namespace

Proxy::Proxy(std::size_t max_parts, const ProxySettings& settings)
    : settings_(settings), surroundings_(max_parts) {}

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

// Whether the force may change although neither hand nor bodies have moved.
bool Proxy::take_in_jumps() {
    const bool missed = scene_->ticks() > std::exchange(scene_ticks_, scene_->ticks()) + 1;
    const bool other_sphere =
        settings_.radius != settled_.radius || settings_.mask != settled_.mask || missed;
    const std::uint64_t since = std::exchange(revision_, scene_->revision());
    const bool other_material =
        std::exchange(material_changes_, scene_->material_changes()) != scene_->material_changes();
    settled_ = settings_;
    if (!other_sphere && since == revision_) {
        return other_material;
    }
    if (present_) {
        let_go(let_out(*scene_, since, other_sphere, sphere(), surroundings_.passed(), surroundings_.work()));
    }
    return true;
}

// Where more bodies stand in the way than can be passed one by one, nothing is touched until there is room.
void Proxy::let_go(bool every) {
    present_ = present_ && every;
    contacts_hold_ = false;
}

// Straight on as far as the way is known to be free. A long way over a rough surface mostly ends early, and
// the bounds of a short one leave out far more: it is gone in strides, each as long as the last ones let it
// be.
Hit Proxy::advance(const Vec3& motion, FeatureId& stopped_by, int except) {
    const Vec3 origin = position_;
    const double length = glm::length(motion);
    Hit hit;
    for (double gone = 0.0; gone < 1.0 && hit.is_free();) {
        const double share = stride_ / std::max(length, 1e-300);
        const double end = gone + share > 0.99 ? 1.0 : gone + share;
        hit = surroundings_.sweep(position_, motion * (end - gone), stopped_by, except);
        const double free_share = (end - gone) * (hit.is_free() ? 1.0 : hit.t);
        gone = hit.is_free() ? end : gone + free_share;
        stride_ = std::max(least_stride * settings_.radius,
                           hit.is_free() ? 4.0 * stride_ : 2.0 * free_share * length);
        position_ = origin + motion * gone;
        surroundings_.travelled(free_share * length);
    }
    return hit;
}

// The moving body that the proxy rests on most.
int Proxy::carrier() const {
    int body = -1;
    double max_pressure = 0.0;
    for (const Touch& contact : touching()) {
        if (contact.pressure > max_pressure && scene_->body(contact.body).moved) {
            body = contact.body;
            max_pressure = contact.pressure;
        }
    }
    return body;
}

// The body's triangles on their way since the last tick, where the body was then. False where they leave the
// proxy no room.
bool Proxy::ride_deformation(int index) {
    const TouchBody& body = scene_->body(index);
    const bool rests = std::ranges::any_of(touching(), [&](const Touch& c) { return c.body == index; });
    for (std::size_t i = 0; i < body.shape->parts.size(); ++i) {
        const TouchPart& from = body.former->parts[i];
        const TouchPart& to = body.shape->parts[i];
        const Pose placed = compose(body.previous, to.pose);
        const Vec3 local = to_local(placed, position_);
        if (glm::length(local - to.center) > std::max(from.radius, to.radius) + 1.1 * settings_.radius) {
            continue;
        }
        const DeformSweep sweep(*from.tree(), *to.tree());
        const auto advanced = [&](const Vec3& motion) {
            const Vec3 before = position_;
            FeatureId stopped_by;
            advance(direction_to_parent(placed, motion), stopped_by, index);
            return direction_to_local(placed, position_ - before);
        };
        if (!ride({sweep, settings_.radius, rests}, local, surroundings_.work(), advanced)) {
            return false;
        }
    }
    return true;
}

void Proxy::ride_deformations(ProxyTick& tick) {
    for (const int index : scene_->deformed_bodies()) {
        const TouchBody& body = scene_->body(index);
        PassedBodies& passed = surroundings_.passed();
        if ((body.layer & settings_.mask) != 0 && !passed.contains(index) &&
            is_deformation(*body.former, *body.shape) && !ride_deformation(index)) {
            tick.status |= proxy_squeezed;
            let_go(passed.pass(index, PassedBecause::squeezes));
        }
    }
}

// A proxy that rests on a moving body moves with it; one that a moving body runs into is pushed. Neither way
// leads through anything but the body that causes it, which stands at its new place already.
void Proxy::ride_along(ProxyTick& tick) {
    ride_deformations(tick);
    if (scene_->moved_bodies().empty()) {
        return;
    }
    bool free = true;
    FeatureId stopped_by;
    const int carried_by = carrier();
    if (carried_by >= 0) {
        const TouchBody& body = scene_->body(carried_by);
        const Vec3 carried = to_parent(body.pose, to_local(body.previous, position_));
        free = advance(carried - position_, stopped_by, carried_by).is_free();
    }
    bool squeezed = !free;
    Surroundings::Push push;
    for (std::size_t from = 0; surroundings_.next_push(from, position_, free ? carried_by : -1, push);) {
        free = advance(push.displacement, stopped_by, push.body).is_free();
        squeezed = squeezed || !free;
    }
    if (squeezed) {
        tick.status |= proxy_squeezed;
        const std::size_t before = surroundings_.passed().count();
        let_go(let_out_of_squeeze(*scene_, sphere(), surroundings_.passed(), surroundings_.work()));
        tick.jumped = tick.jumped || surroundings_.passed().count() != before;
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
// Friction has no say in that. False where there is nothing to lift.
bool Proxy::lift() {
    const auto below_rest = [&](const Contact& contact) { return contact.gap < -0.25 * tolerances().skin; };
    if (!std::ranges::any_of(contacts_.all(), below_rest)) {
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
    ConstrainedStep step;
    for (bool seen = true; seen;) {
        step = flat_step(pull, contacts_, tolerances().same, work);
        seen = false;
        for (int i = 0; i < step.pressing_count && !work.is_gone(); ++i) {
            if (contacts_[step.pressing[i]].state == ContactState::seen) {
                look.look_closely(contacts_, step.pressing[i]);
                seen = true;
            }
        }
    }
    for (int i = 0; i < step.pressing_count; ++i) {
        surroundings_.keep_in_mind(contacts_[step.pressing[i]].feature);
    }
    if (step.pressing_count == 0) {
        return step;
    }
    doubt(step, pull, descent);
    if (step.pressing_count == TouchList::capacity) {
        return step;
    }
    std::array<Curvature, TouchList::capacity - 1> curvatures;
    for (int i = 0; i < step.pressing_count; ++i) {
        curvatures[static_cast<std::size_t>(i)] = look.curvature_of(contacts_, step.pressing[i]);
    }
    bend_step(step, pull, contacts_, {curvatures.data(), static_cast<std::size_t>(step.pressing_count)},
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
        }
        descent.beyond = drop_after(glm::distance(before, position_));
        descent.dropped = step.pressing_count > 0 ? descent.beyond : 0.0;
        descent.last_bent = step.bent ? glm::distance(before, position_) : 0.0;
        if (hit.is_free() && step.pressing_count == 0) {
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
    keep_touching(step);
    tick.slide = step.pressing_count > 0 ? step.slide : Vec3(0.0);
    if (tick.residual > tolerances().step) {
        tick.status |= proxy_unfinished;
    }
}

ProxyTick Proxy::move(const TouchScene& scene, const Vec3& given_hand) {
    ProxyTick tick;
    scene_ = &scene;
    // Devices do send numbers that are none: the hand stays where it was last.
    constexpr double farthest = 1e9;
    const Vec3 size = glm::abs(given_hand);
    hand_ = size.x <= farthest && size.y <= farthest && size.z <= farthest ? given_hand : hand_;
    const Vec3 hand = hand_;
    if (!present_) {
        surroundings_.jumped(glm::distance(hand, position_));
        position_ = hand;
    }
    const bool changed = surroundings_.begin_tick(scene, position_, settings_.radius, settings_.mask,
                                                  WorkBudget(settings_.max_work, settings_.max_work / 8));
    contacts_hold_ = contacts_hold_ && !changed;
    const bool was_present = present_;
    tick.jumped = take_in_jumps();
    if (present_) {
        ride_along(tick);
    }
    if (was_present && !present_) {
        displace(hand - position_);
        tick.jumped = true;
    }
    if (!present_ && !appear()) {
        touching_.clear();
        tick.position = hand;
        tick.status |= proxy_absent;
        return tick;
    }
    touching_.clear();
    if (!fly(hand)) {
        descend(hand, tick);
    }
    tick.position = position_;
    tick.status |= touching_.count > 0 ? static_cast<std::uint32_t>(proxy_touching) : 0u;
    tick.status |= sliding_ ? static_cast<std::uint32_t>(proxy_sliding) : 0u;
    const PassedBodies& passed = surroundings_.passed();
    if (passed.any(PassedBecause::squeezes)) {
        tick.status |= static_cast<std::uint32_t>(proxy_squeezed) | proxy_letting_out;
    } else if (passed.any(PassedBecause::overlaps)) {
        tick.status |= proxy_letting_out;
    }
    return tick;
}

}  // namespace tactus
