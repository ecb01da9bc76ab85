// What the operator's side tells the far side.
#include <algorithm>

#include "core/geometry/surface_query.hpp"
#include "session/operator_side.hpp"

namespace tactus {

void OperatorSide::acknowledge() {
    constexpr int max_a_tick = 8;
    DiscoveryAcknowledgement acknowledgement;
    for (int i = 0; i < max_a_tick && channel_.port().discovery.next_acknowledgement(acknowledgement); ++i) {
        if (channel_.port().tap) {
            channel_.port().tap->took(acknowledgement);
        }
        channel_.send(acknowledgement);
    }
}

// What the far side needs to do the same: the true hand, and what it presses bodies with.
void OperatorSide::send_sample(SessionLoop& loop, std::size_t index, Nanoseconds now) {
    const SessionLoop::ProxySlot& slot = loop.proxy(index);
    Pointer& pointer = pointers_[index];
    const DeviceSample device = loop.device_sample(slot.description.device);
    const DeadbandSettings& deadband = settings().deadband;
    OperatorSample sample;
    sample.sequence = sample_;
    sample.time = channel_.link().local_time(now);
    sample.pointer = static_cast<std::uint16_t>(index);
    sample.connected = device.connected;
    sample.buttons = device.buttons;
    const Pose& frame = settings().frame;
    sample.position = to_local(frame, slot.hand);
    sample.velocity = direction_to_local(frame, slot.hand_velocity);
    // Traditional: only a passive scheme asks for it, and for what the hand was given.
    const Vec3 given = settings().passivity != Passivity::none ? pointer.force : Vec3(0.0);
    sample.force = direction_to_local(frame, settings().traditional ? given : slot.force);
    if (deadband.enabled && pointer.has_sent && now - pointer.sent_at < deadband.longest_silence) {
        const OperatorSample& last = pointer.sent;
        const Vec3 guessed = guessed_position(last.position, last.velocity,
                                              static_cast<double>(sample_ - last.sequence) * seconds_);
        if (!position_needs_sending(deadband, guessed, sample.position, sample.velocity) &&
            !(uses_force(settings().control) && force_needs_sending(deadband, last.force, sample.force)) &&
            sample.buttons == last.buttons && sample.connected == last.connected) {
            return;
        }
    }
    if (!settings().traditional && settings().control == ControlScheme::position_force_relative) {
        find_nearest(loop, slot, sample);
    }
    pointer.sent = sample;
    pointer.has_sent = true;
    pointer.sent_at = now;
    samples_.add(sample);
}

void OperatorSide::find_nearest(SessionLoop& loop, const SessionLoop::ProxySlot& slot,
                                OperatorSample& sample) const {
    double near = settings().stand_in.near + slot.description.settings.radius;
    for (std::size_t place = 0; place < truths_.places(); ++place) {
        const SessionHandle handle = truths_.body_at(place);
        const SessionLoop::Body* const body = loop.body(handle);
        if (!body || body->motion == Motion::Static || object_of_body_[handle] == no_object) {
            continue;
        }
        const TouchBody& touched = loop.scene().body(body->slot);
        const SurfaceHit nearest =
            nearest_surface(*touched.shape, touched.pose, slot.proxy->position(), near);
        if (nearest.hit) {
            near = nearest.distance;
            sample.nearest_object = object_of_body_[handle];
            sample.position_in_object = to_local(touched.pose, slot.hand);
        }
    }
}

}  // namespace tactus
