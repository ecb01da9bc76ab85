#include "core/haptics/proxy.hpp"

#include "core/haptics/deform_ride.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace tactus {

Proxy::Proxy(std::size_t most_parts, const ProxySettings& settings)
    : settings_(settings), surroundings_(most_parts) {}

// A proxy cannot start inside a surface: it appears where the hand is once there is room, so touch begins
// without a kick. Until then it is absent and follows the hand. A hand that starts by just touching has room
// enough: the first step lifts the sphere off by the thousandth of its radius that may be missing.
bool Proxy::appear() {
    const double room = settings_.radius * (1.0 - 1e-3);
    present_ = surroundings_.has_room(position_, room) &&
               !is_inside_one_sided(*scene_, position_, settings_.mask, surroundings_.work_left());
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
        let_go(let_out(*scene_, since, other_sphere, sphere(), surroundings_.passed(),
                       surroundings_.work_left()));
    }
    return true;
}

// Where more bodies stand in the way than can be passed one by one, nothing is touched until there is room.
void Proxy::let_go(bool every) {
    present_ = present_ && every;
    contacts_hold_ = false;
}

// Straight on until something is in the way.
void Proxy::advance(const Vec3& motion, bool& free, int except) {
    const double t = surroundings_.sweep(position_, motion, except);
    free = t > 1.0;
    const Vec3 moved = free ? motion : motion * t;
    position_ += moved;
    surroundings_.travelled(glm::length(moved));
}

// The moving body that the proxy rests on most.
int Proxy::carrier() const {
    int body = -1;
    double most_pressure = 0.0;
    for (const Contact& contact : touching()) {
        if (contact.pressure > most_pressure && scene_->body(contact.body).moved) {
            body = contact.body;
            most_pressure = contact.pressure;
        }
    }
    return body;
}

// The body's triangles on their way since the last tick, where the body was then. False where they leave the
// proxy no room.
bool Proxy::ride_deformation(int index) {
    const TouchBody& body = scene_->body(index);
    const bool rests = std::ranges::any_of(touching(), [&](const Contact& c) { return c.body == index; });
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
            bool free = true;
            advance(direction_to_parent(placed, motion), free, index);
            return direction_to_local(placed, position_ - before);
        };
        if (!ride({sweep, settings_.radius, rests}, local, surroundings_.work_left(), advanced)) {
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
    const int carried_by = carrier();
    if (carried_by >= 0) {
        const TouchBody& body = scene_->body(carried_by);
        const Vec3 carried = to_parent(body.pose, to_local(body.previous, position_));
        advance(carried - position_, free, carried_by);
    }
    bool squeezed = !free;
    Surroundings::Push push;
    for (std::size_t from = 0; surroundings_.next_push(from, position_, free ? carried_by : -1, push);) {
        advance(push.displacement, free, push.body);
        squeezed = squeezed || !free;
    }
    if (squeezed) {
        tick.status |= proxy_squeezed;
        const std::size_t before = surroundings_.passed().count();
        let_go(let_out_of_squeeze(*scene_, sphere(), surroundings_.passed(), surroundings_.work_left()));
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
        const Contact& contact = contacts_.items[static_cast<std::size_t>(step.pressing[i])];
        const TouchMaterial& material = scene_->body(contact.body).material;
        const bool at_rest = contact.gap <= 4.0 * surroundings_.tolerances().skin + dropped;
        const double coefficient = sliding_ ? material.dynamic_friction : material.static_friction;
        limit += at_rest ? coefficient * step.pressure[i] : 0.0;
    }
    return limit;
}

void Proxy::keep_touching(const ConstrainedStep& step) {
    touching_.clear();
    for (int i = 0; i < step.pressing_count; ++i) {
        Contact contact = contacts_.items[static_cast<std::size_t>(step.pressing[i])];
        // Where moving bodies squeeze the proxy it cannot get out of their way: what they overlap it by
        // presses, too.
        contact.pressure = step.pressure[i] + std::max(0.0, -contact.gap - surroundings_.tolerances().skin);
        touching_.add(contact);
    }
}

// Out of what a moving body or the rounding of far coordinates let overlap, before anything slides along it.
// Friction has no say in that. False where there is nothing to lift.
bool Proxy::lift() {
    const Tolerances& tolerances = surroundings_.tolerances();
    const auto below_rest = [&](const Contact& contact) { return contact.gap < -0.25 * tolerances.skin; };
    if (!std::ranges::any_of(contacts_.all(), below_rest)) {
        return false;
    }
    const Vec3 motion = lift_to_rest(contacts_, tolerances.same);
    if (glm::length(motion) <= tolerances.step) {
        return false;
    }
    const Vec3 before = position_;
    bool free = true;
    advance(motion, free);
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
    if (left > surroundings_.tolerances().step && !sliding_) {
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

void Proxy::descend(const Vec3& hand, ProxyTick& tick) {
    const Tolerances& tolerances = surroundings_.tolerances();
    bool slid = false;
    bool keep_all = false;
    double beyond = 0.0;   // how far above a surface the last step may have ended
    double dropped = 0.0;  // the same, where it led along one
    ConstrainedStep step;
    for (tick.steps = 0; tick.steps < settings_.most_steps; ++tick.steps) {
        if (!contacts_hold_) {
            surroundings_.find_contacts(position_, contacts_, beyond, keep_all);
            contacts_hold_ = !keep_all;
        }
        if (lift()) {
            contacts_hold_ = false;
            continue;
        }
        step = constrained_step(hand - position_, contacts_, tolerances.same);
        brake(step, dropped);
        tick.residual = glm::length(step.motion);
        if (tick.residual <= tolerances.step || !surroundings_.may_go_on()) {
            break;
        }
        slid = slid || (step.pressing_count > 0 && step.motion != step.drop);
        bool free = true;
        const Vec3 before = position_;
        advance(step.motion, free);
        contacts_hold_ = false;
        beyond = drop_after(glm::distance(before, position_));
        dropped = step.pressing_count > 0 ? beyond : 0.0;
        // Stopped without having moved by something that is no contact: look at every edge and corner there
        // is.
        keep_all = !free && position_ == before;
        if (free && step.pressing_count == 0) {
            ++tick.steps;
            tick.residual = 0.0;
            break;
        }
    }
    sliding_ = sliding_ && slid;
    keep_touching(step);
    tick.slide = step.pressing_count > 0 ? step.slide : Vec3(0.0);
    if (tick.residual > tolerances.step) {
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
    const bool changed = surroundings_.begin_tick(scene, position_, settings_.radius, settings_.mask);
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
