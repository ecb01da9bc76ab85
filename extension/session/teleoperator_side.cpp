#include "session/teleoperator_side.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_spring.hpp"
#include "network/plausibility.hpp"

namespace tactus {

namespace {

// A hand that comes back no farther from where it was lost, in the frame of what it pressed, presses still
// (unit: meters).
constexpr double same_hand = 0.05;

}  // namespace

TeleoperatorSide::TeleoperatorSide(const SessionSettings& session, const TeleopSettings& settings, Link& link,
                                   std::shared_ptr<TeleopPort> port, const EndpointSettings& endpoint,
                                   const PointerShare& share)
    : channel_(settings, link, std::move(port), endpoint),
      telling_(session.max_bodies),
      share_(share),
      hands_(channel_, share.most(), to_seconds(session.period)),
      seconds_(to_seconds(session.period)) {}

void TeleoperatorSide::set_hands(SessionLoop& loop, Nanoseconds now) {
    const bool changed = channel_.begin_tick(now);
    telling_.take_orders(channel_.port());
    receive(loop);
    hands_.follow(channel_, changed);
    if (!channel_.link().hears_peer()) {
        release_hands(loop);
    }
    for (std::size_t i = 0; i < share_.most(); ++i) {
        if (SessionLoop::ProxySlot& slot = slot_of(loop, i); slot.proxy) {
            play(loop, i, slot);
        }
    }
    for (std::size_t i = 0; i < share_.most(max_tools); ++i) {
        if (ToolSlot* const slot = tool_of(loop, i)) {
            play(loop, tools_[i], *slot);
        }
    }
}

void TeleoperatorSide::receive(SessionLoop& loop) {
    start_over_if_peer_has(loop);
    while (const Packet* const packet = channel_.receive()) {
        start_over_if_peer_has(loop);
        const Message& message = packet->message;
        if (const auto* const samples = std::get_if<OperatorSamples>(&message)) {
            hands_.take(*samples, [&](std::size_t tool) { return tool_of(loop, tool); });
        } else if (const auto* const known = std::get_if<DiscoveryAcknowledgement>(&message)) {
            telling_.take(*known);
        }
    }
}

void TeleoperatorSide::start_over_if_peer_has(SessionLoop& loop) {
    if (channel_.peer_has_started()) {
        release_hands(loop);
        telling_.restart();
        force_pace_.restart();
    }
}

// Nobody is there: the pointers touch nothing, and what comes next is a new beginning.
void TeleoperatorSide::release_hands(SessionLoop& loop) {
    newest_applied_ = no_sample;
    hands_.restart();
    for (Pointer& pointer : pointers_) {
        pointer.holds = false;
    }
    for (std::size_t i = 0; i < share_.most(max_tools); ++i) {
        if (ToolSlot* const slot = tool_of(loop, i)) {
            PlayedHands::restart(*slot);
            tools_[i].holds = false;
        }
    }
}

void TeleoperatorSide::play(SessionLoop& loop, std::size_t index, SessionLoop::ProxySlot& slot) {
    Pointer& pointer = pointers_[index];
    const bool waits = hands_.play(index, pointer.played) == Playing::waiting;
    if (!waits) {
        const Pose& frame = settings().frame;
        pointer.here = pointer.played;
        pointer.here.position = to_parent(frame, pointer.played.position);
        pointer.here.velocity = direction_to_parent(frame, pointer.played.velocity);
        pointer.here.force = direction_to_parent(frame, pointer.played.force);
    }
    if (waits || !pointer.played.connected) {
        if (!slot.idle) {
            keep(loop, pointer, slot);
        }
        slot.idle = true;
        pointer.holds = false;
        return;
    }
    if (!pointer.holds) {
        pointer.hand = pointer.here.position;
        pointer.holds = true;
        pointer.passivity.reset();
        come_back(loop, pointer, slot);
    }
    slot.idle = false;
    newest_applied_ = std::max(newest_applied_, pointer.played.sequence);
    slot.hand_velocity = pointer.here.velocity;
    if (settings().traditional && settings().passivity != Passivity::none) {
        const Vec3 before = pointer.hand;
        pointer.hand = passive_hand(pointer, slot);
        slot.hand_velocity = (pointer.hand - before) / seconds_;
    } else {
        pointer.hand =
            stand_in_hand(settings().control, settings().stand_in, stand_in_input(loop, pointer, slot));
    }
    slot.hand = pointer.hand;
}

// Where the far hand may go so that no energy is made.
Vec3 TeleoperatorSide::passive_hand(Pointer& pointer, const SessionLoop::ProxySlot& slot) const {
    FarPassivity::In in;
    in.sample = pointer.here.sequence;
    in.hand = pointer.here.position;
    in.force = pointer.here.force;
    in.own_force = slot.state.force;
    in.seconds = seconds_;
    return pointer.passivity.hand(settings().passivity, settings().passive, in);
}

// Where a hand that is lost has pressed, so that it can go on pressing.
void TeleoperatorSide::keep(SessionLoop& loop, Pointer& pointer, const SessionLoop::ProxySlot& slot) const {
    pointer.kept_on = slot.state.contact_count > 0 ? slot.state.bodies[0] : no_handle;
    if (const SessionLoop::Body* const under = loop.body(pointer.kept_on)) {
        const Pose& pose = loop.scene().body(under->slot).pose;
        pointer.kept_proxy = to_local(pose, slot.proxy->position());
        pointer.kept_hand = to_local(pose, pointer.hand);
    }
}

// A hand that was lost while it pressed is inside of what it pressed when it comes back: it goes on from
// where its proxy was on that body, wherever that is now.
void TeleoperatorSide::come_back(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot) const {
    const SessionLoop::Body* const under = loop.body(std::exchange(pointer.kept_on, no_handle));
    if (!under) {
        return;
    }
    const Pose& pose = loop.scene().body(under->slot).pose;
    if (glm::distance(to_parent(pose, pointer.kept_hand), pointer.hand) > same_hand) {
        return;
    }
    ProxyMemory memory;
    memory.position = to_parent(pose, pointer.kept_proxy);
    memory.present = true;
    memory.hand = pointer.hand;
    slot.proxy->recall(memory);
}

StandInInput TeleoperatorSide::stand_in_input(SessionLoop& loop, const Pointer& pointer,
                                              const SessionLoop::ProxySlot& slot) const {
    StandInInput in;
    in.hand = pointer.here.position;
    in.velocity = pointer.here.velocity;
    in.force = pointer.here.force;
    in.own_hand = pointer.hand;
    in.own_proxy = slot.state.position;
    in.seconds = seconds_;
    if (const SessionLoop::Body* const near = loop.body(pointer.played.nearest_object)) {
        in.relative = pointer.played.position_in_object;
        in.object = loop.scene().body(near->slot).pose;
    }
    if (slot.state.contact_count > 0) {
        if (const SessionLoop::Body* const touched = loop.body(slot.state.bodies[0])) {
            const TouchBody& body = loop.scene().body(touched->slot);
            const auto touching = slot.proxy->touching();
            const TouchMaterial& material =
                touching.empty() ? body.material : *feel_at(loop.scene(), touching[0]).material;
            in.in_contact = true;
            in.stiffness = spring_of(material).secant(glm::length(in.force));
            in.own_proxy = to_parent(body.pose, to_local(body.previous, slot.state.position));
        }
    }
    return in;
}

void TeleoperatorSide::report(SessionLoop& loop, Nanoseconds now) {
    telling_.tell_states(loop, channel_, newest_applied_, now);
    telling_.tell_estimates(loop, channel_, nullptr, now);
    if (settings().traditional) {
        send_back(loop, now);
    } else {
        tell_tools(loop, now);
    }
    if (const Ghosts* const others = ghosts_.due(loop, share_, settings().frame, now)) {
        channel_.send(*others);
    }
    for (std::size_t i = 0; i < share_.most(); ++i) {
        Pointer& pointer = pointers_[i];
        const SessionLoop::ProxySlot& slot = slot_of(loop, i);
        if (!slot.proxy || slot.idle) {
            pointer.had_force = Vec3(0.0);
            continue;
        }
        // What the last tick's force has done on the way since.
        statistics_.energy.far_J += glm::dot(pointer.had_force, slot.hand - pointer.had_hand);
        pointer.had_force = slot.state.force;
        pointer.had_hand = slot.hand;
    }
    telling_.describe(channel_, now);
    statistics_.sample = newest_applied_;
    hands_.tell(statistics_);
    statistics_.discovery = telling_.counts();
    channel_.end_tick(statistics_);
}

void TeleoperatorSide::send_back(SessionLoop& loop, Nanoseconds now) {
    if (!telling_.yields()) {
        force_pace_.adapt(channel_.link(), now);
    }
    if (++force_tick_ % force_pace_.stride() == 0) {
        send_forces(loop, now);
        send_wrenches(loop, now);
    }
}

void TeleoperatorSide::send_forces(SessionLoop& loop, Nanoseconds now) {
    ForceSamples message;
    for (std::size_t i = 0; i < share_.most() && message.count < ForceSamples::max_count; ++i) {
        if (pointers_[i].holds && slot_of(loop, i).present() && force_is_due(loop, i, now)) {
            message.samples[message.count++] = force_of(loop, i, now);
        }
    }
    if (message.count == 0 || !channel_.try_send(message)) {
        return;
    }
    for (std::size_t i = 0; i < message.count; ++i) {
        const std::size_t index = message.samples[i].pointer;
        Pointer& pointer = pointers_[index];
        pointer.force_sent = slot_of(loop, index).state.force;
        pointer.force_sent_at = now;
    }
}

bool TeleoperatorSide::force_is_due(SessionLoop& loop, std::size_t index, Nanoseconds now) const {
    const Pointer& pointer = pointers_[index];
    return force_needs_sending(settings().deadband, pointer.force_sent, slot_of(loop, index).state.force) ||
           now - pointer.force_sent_at >= settings().deadband.longest_silence;
}

ForceSample TeleoperatorSide::force_of(SessionLoop& loop, std::size_t index, Nanoseconds now) const {
    const ProxyState& state = slot_of(loop, index).state;
    ForceSample sample;
    sample.pointer = static_cast<std::uint16_t>(index);
    sample.true_at = channel_.link().local_time(now);
    sample.newest_operator_sample = pointers_[index].played.sequence;
    sample.force = glm::clamp(direction_to_local(settings().frame, state.force), -plausible::max_force,
                              plausible::max_force);
    sample.proxy = to_local(settings().frame, state.position);
    sample.object = state.contact_count > 0 ? static_cast<ObjectId>(state.bodies[0]) : no_object;
    return sample;
}

}  // namespace tactus
