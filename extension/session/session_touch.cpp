// What each proxy touches in a tick, and the force that its hand gets of it.
#include <algorithm>
#include <glm/geometric.hpp>

#include "core/geometry/surface_query.hpp"
#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_spring.hpp"
#include "core/math/body_motion.hpp"
#include "session/session_loop.hpp"

namespace tactus {

void SessionLoop::touch_all(Nanoseconds now) {
    if (side_ && !side_->simulates()) {
        for (ProxySlot& slot : proxies_) {
            slot.parts = {};  // nothing is touched here, so nothing is pressed
            slot.punctures.clear();
            if (!slot.present()) {
                slot.state = {};
            }
        }
        return;
    }
    for (ProxySlot& slot : proxies_) {
        if (slot.proxy) {
            slot.force_before = slot.force;
            touch(slot, now);
        }
    }
}

void SessionLoop::fade_jumps() {
    for (ProxySlot& slot : proxies_) {
        if (slot.proxy && slot.description.device < max_devices) {
            slot.state.force = slot.fading.felt(slot.force, force_limit(slot), slot.jumped, slot.step);
        }
    }
    fade_tools();
}

FadingForce::Step SessionLoop::step_of(const ProxySlot& slot) const {
    FadingForce::Step step{slot.hand, slot.hand_velocity, slot.walls.most};
    step.fade = fade_of(slot.description.device);
    step.proxy = slot.proxy->position();
    for (const Touch& contact : slot.proxy->touching()) {
        step.damping = std::max(step.damping, feel_at(scene_, contact).material->damping);
    }
    return step;
}

// At the depth that one surface is pressed to, another one that is softer or stiffer presses otherwise: who
// drags across their border, or against a wall, has not gone that deep into it.
bool SessionLoop::touches_other_walls(ProxySlot& slot) const {
    Stiffnesses now;
    for (const Touch& contact : slot.proxy->touching()) {
        const Feel feel = feel_at(scene_, contact);
        const double stiffness = std::max(spring_of(*feel.material).steepest(),
                                          feel.curve() != nullptr ? feel.curve()->steepest : 0.0);
        now.least = now.most == 0.0 ? stiffness : std::min(now.least, stiffness);
        now.most = std::max(now.most, stiffness);
    }
    const Stiffnesses before = std::exchange(slot.walls, now);
    return before.most > 0.0 && now.most > 0.0 && before != now;
}

// A body that a hand pushes gains speed little by little. One that is set going, put right or stopped by
// another has it from one tick to the next, and the damper of its surface follows.
bool SessionLoop::surface_jumps(const ProxySlot& slot, const HandForce& before) const {
    constexpr double margin = 2.0;  // a push grows within the step
    const double fade = fade_of(slot.description.device);
    const double change = glm::distance(slot.parts.of_speed, before.of_speed);
    if (change <= fade) {
        return false;
    }
    double by_push = 0.0;  // no more than that (unit: newtons)
    for (int i = 0; i < before.contact_count; ++i) {
        const ContactForce& part = before.contacts[i];
        const Body* const pushed = body(handle_of_slot_[static_cast<std::size_t>(part.body)]);
        if (!pushed) {
            continue;
        }
        if (pushed->soft) {
            return false;
        }
        by_push += margin * seconds_ * part.wall.damping * glm::length(part.on_hand) *
                   physics_.mobility(pushed->id, part.point, part.on_hand);
    }
    return change > fade + by_push;
}

// Bodies get their part only now: what a correction of this tick changes is in it.
void SessionLoop::press_all() {
    for (ProxySlot& slot : proxies_) {
        if (slot.proxy) {
            press_bodies(slot);
            for (const ShaftForce& force : slot.punctures.forces()) {
                const Body& pierced = bodies_[handle_of_slot_[static_cast<std::size_t>(force.body)]];
                if (pierced.motion == Motion::Dynamic) {
                    physics_.apply_hand_force(pierced.id, -force.on_hand, force.point);
                }
            }
            if (is_held(slot)) {
                attract(slot, true);
            }
        }
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot) {
            press_bodies(*slot);
        }
    }
}

void SessionLoop::touch(ProxySlot& slot, Nanoseconds now) {
    const HandForce parts_before = std::exchange(slot.parts, {});
    if (!is_held(slot)) {
        slot.force = slot.effects.besides = Vec3(0.0);
        slot.torsion.count = 0;
        slot.aids = {};
        slot.punctures.clear();
        slot.proxy->restart();
        slot.walls = {};
        const ProxyState before = std::exchange(slot.state, {});
        slot.state.position = slot.idle ? before.position : slot.hand;
        slot.state.hand = slot.idle ? before.hand : slot.hand;
        slot.state.status = slot.idle ? far_hand_away : touch_unheld;
        slot.step = step_of(slot);
        slot.jumped = true;
        return;
    }
    // A path goes on where it stopped; a real hand may be deep inside a body by now.
    if (std::exchange(slot.rested, false) &&
        glm::distance(slot.hand, slot.state.hand) > slot.proxy->settings().radius) {
        slot.proxy->restart();
    }
    const ProxyTick tick = slot.proxy->move(scene_, slot.hand, seconds_);
    HandForce& force = slot.parts;
    DeviceSlot& device = devices_[slot.description.device];
    const HandMotion motion{slot.hand, slot.hand_velocity};
    const AidedHand hand = aided_hand(slot.description.device, motion, now);
    const AidForce aid = aid_force(slot.description.aids, hand, slot.field, slot.aids);
    const bool changed = std::exchange(slot.changed, false);
    const Wall within = feel_punctures(slot, hand, aid.damping);
    const double left = aid.damping - damping_needed(within.stiffness, hand.lag) - within.damping;
    force = contact_force(scene_, slot.proxy->touching(), tick.slide, slot.hand_velocity, seconds_,
                          {hand.lag, left, slot.description.finger.stiffness, slot.proxy->settings().radius});
    slot.pressed = force.total;
    note_walls(slot, device);
    break_surfaces(slot, force);
    add_surface_effects(scene_, slot.proxy->touching(), motion, now, seconds_, slot.effects, force);
    slot.jumped = touches_other_walls(slot) || tick.jumped || aid.jumped || changed ||
                  surface_jumps(slot, parts_before);
    if (slot.description.force_law == ForceLaw::smoothed && !slot.jumped) {
        smooth(force, slot.force_before - slot.effects.besides);
    }
    const double max_change = max_pull_rate * seconds_ / device.workspace.force_scale;
    slot.effects.besides = aid.force + slot.punctures.total() +
                           gradual_pull(attract(slot, false), max_change, magnet_changes_, slot.effects);
    slot.force = force.total + slot.effects.besides;
    slot.step = step_of(slot);
    slot.step.stiffness += aid.wall.stiffness + within.stiffness;
    slot.step.damping += aid.wall.damping + within.damping;
    slot.sliding = (tick.status & proxy_sliding) != 0;
    hold_against_turning(slot);
    status_ |= tick.status & proxy_unfinished ? static_cast<TickStatus>(session_proxy_unfinished) : 0u;
    describe(slot, tick);
}

// Magnetic surfaces pull from a distance, and are pulled where `press` says so.
Vec3 SessionLoop::attract(const ProxySlot& slot, bool press) {
    Vec3 pull(0.0);
    const ProxySettings& proxy = slot.proxy->settings();
    for (const SessionHandle handle : magnets_) {
        const Body& magnet = bodies_[handle];
        const TouchBody& surface = scene_.body(magnet.slot);
        const double far = proxy.radius + surface.material.magnet_range;
        if ((surface.layer & proxy.mask) == 0) {
            continue;
        }
        const SurfaceHit nearest = nearest_surface(*surface.shape, surface.pose, slot.proxy->position(), far);
        const double strength = magnet_pull(surface.material, nearest.distance - proxy.radius);
        const Vec3 on_hand = nearest.normal * -strength;
        pull += on_hand;
        if (press && magnet.motion == Motion::Dynamic) {
            physics_.apply_hand_force(magnet.id, -on_hand,
                                      slot.proxy->position() - nearest.normal * nearest.distance);
        }
    }
    return pull;
}

// What each contact of a soft finger holds the body by against turning. Over a link only places are told: a
// finger there does not turn, and neither does that of the model.
void SessionLoop::hold_against_turning(ProxySlot& slot) const {
    const SoftFinger& finger = slot.description.finger;
    if (!finger.is_soft()) {
        slot.torsion.count = 0;
        return;
    }
    const Vec3 hand_turn = side_ ? Vec3(0.0) : devices_[slot.description.device].hand_turn;
    const TorsionList before = std::exchange(slot.torsion, {});
    for (int i = 0; i < slot.parts.contact_count; ++i) {
        const Touch& contact = slot.proxy->touching()[static_cast<std::size_t>(i)];
        const TouchBody& body = scene_.body(contact.body);
        const Feel feel = feel_at(scene_, contact);
        const double share =
            friction_share(scene_, feel, contact.body, contact.feature, contact.point, contact.normal);
        const Vec3& on_hand = slot.parts.contacts[i].on_hand;
        const double pressing = std::max(0.0, glm::dot(on_hand, contact.normal));
        const double along = glm::length(on_hand - contact.normal * glm::dot(on_hand, contact.normal));
        const double slipping =
            torsion_limit(finger, share * feel.material->dynamic_friction, pressing, along);
        const double at_rest = torsion_limit(finger, share * feel.material->static_friction, pressing, along);
        const Vec3 body_turn =
            body.moved ? turn_vector(body.pose.rotation * glm::conjugate(body.previous.rotation)) : Vec3(0.0);
        Torsion torsion = before.grip_of(contact.body, contact.normal);
        turn_in_grip(torsion, {slot.sliding ? slipping : std::max(slipping, at_rest), slipping},
                     glm::dot(body_turn - hand_turn, contact.normal));
        torsion.finger_spin = glm::dot(hand_turn, contact.normal) / seconds_;
        slot.torsion.add(torsion);
    }
}

void SessionLoop::describe(ProxySlot& slot, const ProxyTick& tick) {
    ProxyState& state = slot.state;
    state.position = tick.position;
    state.hand = slot.hand;
    state.hand_velocity = slot.hand_velocity;
    state.force = slot.force;
    state.residual = tick.residual;
    state.status = tick.status | (slot.field.is_limited() ? touch_field_limited : 0u);
    state.contact_count = 0;
    for (const Touch& contact : slot.proxy->touching()) {
        if (state.contact_count == HandForce::max_contacts) {
            break;
        }
        const auto i = static_cast<std::size_t>(state.contact_count++);
        state.bodies[i] = handle_of_slot_[static_cast<std::size_t>(contact.body)];
        state.points[i] = contact.point;
        state.normals[i] = contact.normal;
        state.forces[i] = slot.parts.contacts[i].on_hand;
    }
}

}  // namespace tactus
