// What the operator's side tells the far side.
#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "core/geometry/surface_query.hpp"
#include "core/safety/limited_force.hpp"
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

// With a deadband: whether the far side guesses what `sample` says. That the hand begins or ceases to touch
// its model it does not: no guess there touches what the hand does not.
bool OperatorSide::is_guessed(const SentHand& sent, const OperatorSample& sample) const {
    const DeadbandSettings& deadband = settings().deadband;
    const OperatorSample& last = sent.last;
    const double seconds = static_cast<double>(sample_ - last.sequence) * seconds_;
    const Vec3 guessed = guessed_position(last.position, last.velocity, seconds);
    const Quat turned = turn_by(last.spin, guessed_time(seconds)) * last.rotation;
    return deadband.enabled && sent.since != no_sample &&
           !position_needs_sending(deadband, guessed, sample.position, sample.velocity) &&
           is_press_guessed(last.force, sample.force) &&
           (!sample.has_turn || angle_between(turned, sample.rotation) <= deadband.angle) &&
           sample.buttons == last.buttons && sample.connected == last.connected;
}

bool OperatorSide::is_press_guessed(const Vec3& last, const Vec3& force) const {
    if (settings().traditional && settings().passivity != Passivity::none) {
        return true;
    }
    const double before = glm::length(last), now = glm::length(force);
    const bool falls = settings().traditional && press_needs_sending(now, before);
    return (before == 0.0) == (now == 0.0) && !press_needs_sending(before, now) && !falls;
}

bool OperatorSide::is_due(const SentHand& sent, Nanoseconds now) const {
    const double spin = sent.last.has_turn ? glm::length(sent.last.spin) : 0.0;
    return hand_is_due(settings().deadband, {stands(glm::length(sent.last.velocity), spin),
                                             sent.acknowledged >= sent.since, now - sent.at});
}

void OperatorSide::send(SentHand& sent, const OperatorSample& sample, bool says_nothing_new,
                        Nanoseconds now) {
    sent.since = says_nothing_new ? sent.since : sample.sequence;
    sent.last = sample;
    sent.at = now;
    samples_.add(sample);
}

// Whether a hand is there for the far side. One that comes and has no room in the model presses nothing
// there, and nothing at the far side. One that a correction has left no room presses on there.
bool OperatorSide::is_told(SentHand& sent, std::uint32_t start, bool is_held, bool has_room) const {
    const bool has_come = std::exchange(sent.start, start) != start;
    sent.had_room = is_held && ((sent.had_room && !has_come) || has_room || settings().traditional);
    return sent.had_room && !waits_for_model();
}

// A hand that was there and is not: said until the far side has heard it, and now and then after that.
void OperatorSide::send_absence(SentHand& sent, Nanoseconds now) {
    sent.had_room = false;
    if (sent.since == no_sample) {
        return;
    }
    const bool is_news = sent.last.connected;
    DeadbandSettings settings_of_absence = settings().deadband;
    settings_of_absence.enabled = true;
    if (!is_news &&
        !hand_is_due(settings_of_absence, {true, sent.acknowledged >= sent.since, now - sent.at})) {
        return;
    }
    OperatorSample gone = sent.last;
    gone.sequence = sample_;
    gone.time = channel_.link().local_time(now);
    gone.connected = false;
    gone.buttons = 0;
    gone.velocity = gone.force = gone.spin = Vec3(0.0);
    send(sent, gone, !is_news, now);
}

// Without a model, see DeniedPress. `force`: that the far side has told.
Vec3 OperatorSide::far_bound(const DeniedPress& denied, const Vec3& force) const {
    const double size = glm::length(force);
    return denied.binds() && size > 0.0 ? force * (denied.most() / size) : Vec3(0.0);
}

void OperatorSide::note_denied(SessionLoop& loop, std::size_t index) {
    const SessionLoop::ProxySlot& slot = loop.proxy(index);
    Pointer& pointer = pointers_[index];
    const Vec3& pressed = settings().traditional ? pointer.modelled : slot.force;
    const Vec3 wanted =
        pointer.carried.apart() ? limited_force(slot.force, loop.force_limit(slot)) : pointer.modelled;
    const Vec3 shown = limited_force(slot.state.force, loop.force_limit(slot));
    pointer.sent.denied.step({glm::length(pressed), glm::length(wanted), glm::length(shown),
                              glm::length(pointer.force), seconds_});
}

// What the far side needs to do the same: the hand, and what it presses bodies with.
void OperatorSide::send_sample(SessionLoop& loop, std::size_t index, Nanoseconds now) {
    const SessionLoop::ProxySlot& slot = loop.proxy(index);
    Pointer& pointer = pointers_[index];
    const DeviceSample device = loop.device_sample(slot.description.device);
    const DeadbandSettings& deadband = settings().deadband;
    note_denied(loop, index);
    const DeniedPress& denied = pointer.sent.denied;
    const bool is_nearer = denied.binds() && !settings().traditional;
    const Vec3 hand =
        is_nearer ? nearer(slot.hand, slot.proxy->position(), slot.force, denied.share()) : slot.hand;
    OperatorSample sample;
    sample.sequence = sample_;
    sample.time = channel_.link().local_time(now);
    sample.pointer = static_cast<std::uint16_t>(index);
    sample.connected = is_told(pointer.sent, slot.proxy->starts(), device.connected,
                               (slot.state.status & proxy_absent) == 0);
    sample.buttons = device.buttons;
    const Pose& frame = settings().frame;
    sample.position = to_local(frame, hand);
    sample.velocity = is_nearer ? Vec3(0.0) : direction_to_local(frame, slot.hand_velocity);
    const Vec3 force = !settings().traditional                   ? denied.share() * slot.force
                       : settings().passivity != Passivity::none ? pointer.passivity.told()
                                                                 : far_bound(denied, pointer.modelled);
    sample.force = direction_to_local(frame, force);
    SentHand& sent = pointer.sent;
    const bool same_force =
        !uses_force(settings().control) || !force_needs_sending(deadband, sent.last.force, sample.force);
    const bool says_nothing_new = same_force && is_guessed(sent, sample);
    if (says_nothing_new && !is_due(sent, now)) {
        return;
    }
    if (!settings().traditional && settings().control == ControlScheme::position_force_relative) {
        find_nearest(loop, slot, hand, sample);
    }
    send(sent, sample, says_nothing_new, now);
}

void OperatorSide::find_nearest(SessionLoop& loop, const SessionLoop::ProxySlot& slot, const Vec3& hand,
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
            sample.position_in_object = to_local(touched.pose, hand);
        }
    }
}

}  // namespace tactus
