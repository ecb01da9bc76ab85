// What comes of touch besides its force: surfaces that break, what is felt within bodies, what the owner
// hears of it, and rows of recordings.
#include <algorithm>
#include <glm/geometric.hpp>
#include <span>

#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_way.hpp"
#include "session/session_loop.hpp"

namespace tactus {

// Like what acts besides touch, punctured bodies have half of the damping that is left. How steep they are.
Wall SessionLoop::feel_punctures(ProxySlot& slot, const AidedHand& hand, double damping) {
    const Wall wanted = Punctures::steepest(scene_, slot.proxy->passed_bodies());
    const Wall safe = safe_wall(hand.lag, 0.5 * damping, wanted);
    const double stiff = wanted.stiffness > 0.0 ? safe.stiffness / wanted.stiffness : 1.0;
    const double damped = wanted.damping > 0.0 ? safe.damping / wanted.damping : 1.0;
    slot.punctures.tick(scene_, slot.proxy->passed_bodies(), hand.motion, std::min(stiff, damped), seconds_);
    return safe;
}

// A surface pressed harder than it bears lets the proxy through from the next tick on.
void SessionLoop::break_surfaces(ProxySlot& slot, const HandForce& force) {
    for (int i = 0; i < force.contact_count; ++i) {
        const ContactForce& part = force.contacts[i];
        const double bears = feel_at(scene_, part.body, part.feature).material->pop_through_force;
        const double pressed = glm::length(part.on_hand);
        if (bears > 0.0 && pressed > bears) {
            const Pose& pose = scene_.body(part.body).pose;
            const Vec3& normal = slot.proxy->touching()[static_cast<std::size_t>(i)].normal;
            slot.proxy->pass_through(part.body,
                                     {to_local(pose, part.point), direction_to_local(pose, normal), pressed});
        }
    }
}

// Once a tick, from what both kinds of hands touch by now.
void SessionLoop::note_events() {
    for (std::size_t i = 0; i < proxies_.size(); ++i) {
        ProxySlot& slot = proxies_[i];
        if (slot.proxy) {
            note_impacts(slot);
            note_breaks(slot);
            for (int k = 0; k < slot.parts.contact_count; ++k) {
                received_[i] += seconds_ * slot.parts.contacts[k].on_hand;
            }
        }
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot) {
            note_impacts(*slot);
        }
    }
}

// Of a surface that moves, the speed of the hand against it.
ImpactContact SessionLoop::impact_of(const Touch& touch, const Vec3& velocity, const Vec3& force) const {
    const Vec3 relative = velocity - way_of_surface(scene_, touch) / seconds_;
    return {handle_of_slot_[static_cast<std::size_t>(touch.body)], -glm::dot(relative, touch.normal),
            glm::dot(force, touch.normal)};
}

void SessionLoop::note_impacts(ProxySlot& slot) const {
    std::array<ImpactContact, HandForce::max_contacts> contacts;
    const auto count = static_cast<std::size_t>(slot.parts.contact_count);
    for (std::size_t i = 0; i < count; ++i) {
        contacts[i] =
            impact_of(slot.proxy->touching()[i], slot.hand_velocity, slot.parts.contacts[i].on_hand);
    }
    slot.impacts.tick(std::span(contacts).first(count), seconds_, slot.events);
}

void SessionLoop::note_impacts(ToolSlot& slot) const {
    std::array<ImpactContact, ImpactWatch::most> contacts;
    std::size_t count = 0;
    for (const ToolTouch& touch : slot.proxy.touching()) {
        if (count < contacts.size()) {
            contacts[count++] = impact_of(surface_of(touch), slot.hand.velocity_at(touch.point),
                                          touch.force * slot.hand.share);
        }
    }
    slot.impacts.tick(std::span(contacts).first(count), seconds_, slot.events);
}

// A proxy that is not held, or has yet to begin, has left all.
void SessionLoop::note_breaks(ProxySlot& slot) const {
    const bool held = is_held(slot) && (slot.state.status & proxy_absent) == 0;
    std::array<BreakWatch::Broken, BreakWatch::most> broken;
    std::size_t count = 0;
    for (const PassedBodies::Passed& passed : slot.proxy->passed_bodies()) {
        if (held && passed.reason == PassedBecause::broken) {
            broken[count++] = {handle_of_slot_[static_cast<std::size_t>(passed.body)], passed.broken.force};
        }
    }
    slot.breaks.tick(std::span(broken).first(count), slot.events);
}

// Of a proxy, or of a tool. False where there is none.
bool SessionLoop::describe_hand(SessionHandle hand, SessionRecord& row) {
    const auto take = [&](const auto& state, const Vec3& goal, const Vec3& position) {
        row.proxy = hand;
        row.hand = goal;
        row.proxy_position = position;
        row.force = state.force;
        row.proxy_status = state.status;
        row.contacts = static_cast<std::uint32_t>(state.contact_count);
    };
    SessionHandle device = no_handle;
    const auto [proxy, tool] = hand_slot(hand);
    if (proxy != nullptr && proxy->proxy) {
        take(proxy->state, proxy->state.hand, proxy->state.position);
        device = proxy->description.device;
    } else if (tool != nullptr) {
        take(tool->state, tool->state.hand.position, tool->state.pose.position);
        device = tool->use.device;
    } else {
        return false;
    }
    if (device < max_devices) {
        const DeviceSlot& slot = devices_[device];
        row.displayed = slot.displayed ? force_in_scene(slot.workspace, slot.displayed->force) : slot.force;
        row.cuts = slot.displayed ? slot.displayed->cuts : 0u;
    }
    return true;
}

void SessionLoop::append_record(const Recording& recording, Nanoseconds now, Nanoseconds late) {
    SessionRecord row;
    if (!describe_hand(recording.proxy, row)) {
        return;
    }
    row.time = now;
    row.ran = now + late;
    if (const Body* object = body(recording.object)) {
        row.object_position = scene_.body(object->slot).pose.position;
        row.object_rotation = scene_.body(object->slot).pose.rotation;
    }
    if (!recording.ring->append(row)) {
        status_ |= session_record_lost;
    }
}

}  // namespace tactus
