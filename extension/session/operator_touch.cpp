// How a correction is brought in without being felt: the pointers that are carried along, and the forces.
#include <algorithm>
#include <glm/geometric.hpp>

#include "session/operator_side.hpp"

namespace tactus {

namespace {

// A force below this is none (unit: newtons).
constexpr double no_force = 1e-9;

// Of a pointer that rests on nothing that says otherwise (unit: newtons per meter).
constexpr double usual_stiffness = 500.0;

}  // namespace

// --- correcting

// What would be felt in this tick without a correction. True where a pointer has just come to touch
// something: a correction would have to hide a force that nobody has felt yet; it waits for the next tick.
bool OperatorSide::lands(SessionLoop& loop, Nanoseconds now) {
    bool any = false;
    for (std::size_t i = 0; i < most_proxies; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (!slot.present()) {
            continue;
        }
        Pointer& pointer = pointers_[i];
        const Proxy& proxy = pointer.apart ? *pointer.felt.proxy : *slot.proxy;
        const bool was_free = proxy.touching().empty();
        pointer.force_before = force_uncorrected(loop, pointer, slot, now);
        any = any || (was_free && glm::length(pointer.force_before) > no_force);
    }
    return any && is_stealthy(settings_.correction);
}

void OperatorSide::correct(SessionLoop& loop) {
    ++statistics_.corrections;
    const bool with_velocity = settings_.correction != Correction::pose;
    for (const Target& target : targets_) {
        const Pose from = loop.scene().body(loop.body(target.body)->slot).pose;
        const Pose motion = displacement(from, target.motion.pose);
        statistics_.cost.moved =
            std::max(statistics_.cost.moved, glm::length(target.motion.pose.position - from.position));
        const bool rides = carry(loop, target, motion);
        loop.put_right(target.body, target.motion, with_velocity, rides,
                       target.previous ? &*target.previous : nullptr);
    }
    // The pointers that press go on from where the replay has led them.
    for (std::size_t i = 0; i < most_proxies; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (targets_.front().previous && slot.proxy && twin_->proxy(i).proxy) {
            slot.proxy->recall(twin_->proxy(i).proxy->memory());
        }
        if (slot.present() && pointers_[i].apart) {
            lean_on_pressing(pointers_[i], slot);
        }
    }
}

// What would be felt in this tick if nothing were corrected. The pointers are left as they were.
Vec3 OperatorSide::force_uncorrected(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot,
                                     Nanoseconds now) const {
    const auto try_out = [&](SessionLoop::ProxySlot& tried) {
        const ProxyMemory memory = tried.proxy->memory();
        const EffectMemory effects = tried.effects;
        const Vec3 before = tried.force;
        tried.force_before = before;
        loop.touch(tried, now);
        const Vec3 force = tried.force;
        tried.proxy->recall(memory);
        tried.effects = effects;
        tried.force = before;
        return force;
    };
    if (!pointer.apart) {
        return pointer.bridge.felt(try_out(slot));
    }
    pointer.felt.hand = slot.hand + pointer.offset;
    pointer.felt.hand_velocity = slot.hand_velocity;
    return pointer.bridge.felt(try_out(pointer.felt));
}

// The felt pointers that rest on the body travel with it. True where one does.
bool OperatorSide::carry(SessionLoop& loop, const Target& target, const Pose& motion) {
    bool any = false;
    if (!is_stealthy(settings_.correction)) {
        return any;
    }
    for (std::size_t i = 0; i < most_proxies; ++i) {
        Pointer& pointer = pointers_[i];
        const SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (!pointer.felt.proxy || !slot.present()) {
            continue;
        }
        if (!pointer.apart) {
            part(pointer, slot);
        }
        Proxy& proxy = *pointer.felt.proxy;
        if (!loop.rests_on(proxy, target.body)) {
            continue;
        }
        any = true;
        const Vec3 hand = slot.hand + pointer.offset;
        // It has not moved in this tick yet: it goes from where the body was to where it has been instead.
        const Pose& was = loop.scene().body(loop.body(target.body)->slot).previous;
        const Pose before = target.previous ? displacement(was, *target.previous) : motion;
        proxy.displace(to_parent(before, proxy.position()) - proxy.position());
        const Vec3 offset = to_parent(motion, hand) - slot.hand;
        note_drift(loop, pointer, glm::length(offset - pointer.offset));
        pointer.offset = offset;
        if (const double length = glm::length(pointer.offset); length > settings_.stealth.longest_offset) {
            pointer.offset *= settings_.stealth.longest_offset / length;
        }
    }
    return any;
}

// The felt pointer begins where the pressing one is.
void OperatorSide::part(Pointer& pointer, const SessionLoop::ProxySlot& slot) const {
    pointer.active = true;
    pointer.apart = true;
    pointer.offset = Vec3(0.0);
    SessionLoop::ProxySlot& felt = pointer.felt;
    felt.description = slot.description;
    felt.proxy->set_settings(slot.description.settings);
    felt.proxy->recall(slot.proxy->memory());
    felt.force = slot.force;
    felt.effects = slot.effects;
    felt.state = slot.state;
}

// What friction holds is the same for both pointers: where both rest on something, the felt one stands beside
// the pressing one, along the surfaces.
void OperatorSide::lean_on_pressing(Pointer& pointer, const SessionLoop::ProxySlot& slot) const {
    const Proxy& pressing = *slot.proxy;
    if (pressing.touching().empty() || pointer.felt.proxy->touching().empty() ||
        pressing.touching().front().body != pointer.felt.proxy->touching().front().body) {
        return;
    }
    Vec3 along = pointer.offset;
    for (const Touch& contact : pressing.touching()) {
        along -= contact.normal * glm::dot(along, contact.normal);
    }
    pointer.felt.proxy->recall(pressing.memory());
    pointer.felt.proxy->displace(along);
}

// --- feeling

void OperatorSide::set_forces(SessionLoop& loop, Nanoseconds now) {
    if (!settings_.traditional && settings_.correction != Correction::none) {
        apply_drags(loop);
    }
    for (std::size_t i = 0; i < most_proxies; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        Pointer& pointer = pointers_[i];
        if (!slot.present()) {
            pointer.active = pointer.apart = false;
            continue;
        }
        if (settings_.traditional) {
            feel_far_side(pointer, slot);
            continue;
        }
        feel(loop, pointer, slot, now);
    }
}

// Of what is touched there, no more is known than which object, and where the force points.
void OperatorSide::feel_far_side(const Pointer& pointer, SessionLoop::ProxySlot& slot) const {
    ProxyState& state = slot.state;
    state.hand = slot.hand;
    state.position = pointer.far_sample != no_sample ? pointer.far_proxy : slot.hand;
    state.force = link_.hears_peer() ? pointer.far_force : Vec3(0.0);
    state.status = 0;
    state.contact_count = 0;
    const double size = glm::length(state.force);
    if (pointer.far_object < body_of_object_.size() && size > no_force) {
        state.status = proxy_touching;
        state.contact_count = 1;
        state.bodies[0] = body_of_object_[pointer.far_object];
        state.normals[0] = state.force / size;
        state.points[0] = state.position - slot.proxy->settings().radius * state.normals[0];
    }
}

void OperatorSide::feel(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot, Nanoseconds now) {
    const bool corrected = !targets_.empty();
    if (pointer.active && !corrected) {
        fade(loop, pointer, slot);
    }
    if (pointer.apart) {
        const Vec3 force = felt_apart(loop, pointer, slot, now);
        if (corrected ? presses_as_felt(pointer, slot) : pointer.offset == Vec3(0.0)) {
            // From now on the pressing pointer is felt.
            pointer.apart = false;
            pointer.offset = Vec3(0.0);
            pointer.bridge = bridge(slot.force, force, true);
        } else {
            slot.state = pointer.felt.state;
            slot.state.hand = slot.hand;
            slot.state.force = force;
        }
    }
    if (pointer.active && !pointer.apart) {
        slot.state.force = pointer.bridge.felt(slot.force);
        pointer.active = !pointer.bridge.is_none();
    }
    statistics_.offset = glm::length(pointer.offset);
    CorrectionCost& cost = statistics_.cost;
    if (corrected) {
        cost.force_step = std::max(cost.force_step, glm::length(slot.state.force - pointer.force_before));
        statistics_.largest_force_step = std::max(statistics_.largest_force_step, cost.force_step);
    }
    cost.jnd_share =
        (cost.force_step + cost.faded) / just_noticeable(settings_.stealth, glm::length(slot.state.force));
}

// After a correction: whether the pressing pointer needs no more to be made up for than the carried one does.
// Where little was corrected and friction holds, the pointer that stayed has kept its hold better.
bool OperatorSide::presses_as_felt(const Pointer& pointer, const SessionLoop::ProxySlot& slot) const {
    const Vec3& before = pointer.force_before;
    const auto step = [&](const Vec3& force) {
        const bool keep_direction = settings_.correction == Correction::stealthy_direction;
        return glm::distance(bridge(force, before, keep_direction).felt(force), before);
    };
    return is_stealthy(settings_.correction) && slot.parts.contact_count > 0 &&
           pointer.felt.parts.contact_count > 0 &&
           glm::distance(slot.force, before) <= glm::distance(pointer.felt.force, before) &&
           step(slot.force) <= std::max(no_force, step(pointer.felt.force));
}

Vec3 OperatorSide::felt_apart(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot,
                              Nanoseconds now) {
    SessionLoop::ProxySlot& felt = pointer.felt;
    felt.hand = slot.hand + pointer.offset;
    felt.hand_velocity = slot.hand_velocity;
    felt.force_before = felt.force;
    if (slot.parts.contact_count > 0) {
        felt.proxy->set_sliding(slot.sliding);
    }
    loop.touch(felt, now);
    if (!targets_.empty()) {
        hide_correction(loop, pointer, slot, now);
    }
    return pointer.bridge.felt(felt.force);
}

// After the correction the pointer is where the force is nearly what it was; the bridge does the rest. A hand
// that was free stays free: it is kept off what has just come to where it is.
void OperatorSide::hide_correction(SessionLoop& loop, Pointer& pointer, const SessionLoop::ProxySlot& slot,
                                   Nanoseconds now) {
    if (!is_stealthy(settings_.correction)) {
        return;
    }
    if (glm::length(pointer.force_before) < no_force && glm::length(pointer.felt.force) > no_force) {
        pointer.offset = pointer.felt.proxy->position() - slot.hand;
        pointer.bridge = {};
        pointer.felt.hand = slot.hand + pointer.offset;
        loop.touch(pointer.felt, now);
        return;
    }
    const Vec3 without = pointer.bridge.felt(pointer.felt.force);
    pointer.bridge = bridge(pointer.felt.force, pointer.force_before,
                            settings_.correction == Correction::stealthy_direction);
    note_drift(loop, pointer,
               glm::length(pointer.bridge.felt(pointer.felt.force) - without) /
                   stiffness_under(loop, pointer.felt.state));
}

double OperatorSide::stiffness_under(const SessionLoop& loop, const ProxyState& state) const {
    const SessionLoop::Body* const under = state.contact_count > 0 ? loop.body(state.bodies[0]) : nullptr;
    return under ? std::max(1.0, loop.scene().body(under->slot).material.stiffness) : usual_stiffness;
}

void OperatorSide::note_drift(const SessionLoop& loop, Pointer& pointer, double way) const {
    const double unnoticed = settings_.stealth.share *
                             just_noticeable(settings_.stealth, glm::length(pointer.felt.force)) /
                             stiffness_under(loop, pointer.felt.state);
    pointer.drift.carried(settings_.stealth, way, unnoticed);
}

void OperatorSide::fade(const SessionLoop& loop, Pointer& pointer, const SessionLoop::ProxySlot& slot) {
    pointer.drift.pass(settings_.stealth, seconds_);
    const ProxyState& state = pointer.apart ? pointer.felt.state : slot.state;
    if (state.contact_count == 0) {
        pointer.offset = faded(pointer.offset, settings_.stealth.free_speed * seconds_);
        pointer.bridge = {};
        return;
    }
    if (pointer.offset == Vec3(0.0) && pointer.bridge.is_none()) {
        return;
    }
    const double force = glm::length(pointer.apart ? pointer.felt.force : slot.force);
    const double stiffness = stiffness_under(loop, state);
    // Somewhat faster than what comes, so that what has gathered gets less.
    constexpr double catching_up = 1.2;
    const double drift = catching_up * pointer.drift.rate() * seconds_;
    const double change = unnoticed_change(settings_.stealth, force, seconds_) + drift * stiffness;
    const double share = pointer.offset != Vec3(0.0) && !pointer.bridge.is_none() ? 0.5 : 1.0;
    statistics_.cost.faded = change;
    pointer.offset = faded(pointer.offset, share * change / stiffness);
    pointer.bridge = faded(pointer.bridge, force, share * change);
}

}  // namespace tactus
