#include "session/teleoperator_side.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_spring.hpp"
#include "core/math/shortened.hpp"
#include "network/plausibility.hpp"
#include "session/hand_terms.hpp"

namespace tactus {

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
    // Before what has come is taken: after a standstill of this side the first tick hears the peer again.
    if (!channel_.link().hears_peer()) {
        release_hands(loop);
    }
    receive(loop);
    hands_.follow(channel_, changed);
    if (!channel_.link().hears_peer()) {
        release_hands(loop);
    }
    for (std::size_t i = 0; i < share_.most(); ++i) {
        if (SessionLoop::ProxySlot& slot = slot_of(loop, i); slot.proxy) {
            play(loop, i, slot);
        } else {
            pointers_[i].leave();
        }
    }
    for (std::size_t i = 0; i < share_.most(max_tools); ++i) {
        if (ToolSlot* const slot = tool_of(loop, i)) {
            play(loop, i, *slot);
        } else {
            tools_[i].leave();
        }
    }
    draw_back_tools(loop);
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
        forget_operator();
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

// Its hands were elsewhere: those of another operator are not led there from where they were lost.
void TeleoperatorSide::forget_operator() {
    for (Pointer& pointer : pointers_) {
        pointer.is_new = true;
        pointer.kept = {};
    }
    for (Tool& tool : tools_) {
        tool.is_new = true;
        tool.kept = {};
    }
}

void TeleoperatorSide::play(SessionLoop& loop, std::size_t index, SessionLoop::ProxySlot& slot) {
    Pointer& pointer = pointers_[index];
    slot.idle = std::exchange(pointer.is_away, false) || slot.idle;
    pointer.playing = hands_.play(index, pointer.played);
    const bool waits = pointer.playing == Playing::waiting;
    if (!waits) {
        const Pose& frame = settings().frame;
        pointer.here = pointer.played;
        pointer.here.position = to_parent(frame, pointer.played.position);
        pointer.here.velocity = direction_to_parent(frame, pointer.played.velocity);
        pointer.here.force = direction_to_parent(frame, pointer.played.force);
    }
    const bool another_goes = pointer.is_new && !slot.idle;
    if (waits || another_goes || !pointer.played.connected || !telling_.may_press(channel_, index)) {
        let_go(loop, pointer, slot);
        return;
    }
    if (!pointer.holds) {
        pointer.hand = pointer.here.position;
        pointer.holds = true;
        pointer.passivity.reset();
        pointer.limit.come();
        if (slot.idle) {
            pointer.limit.begin();
            come_back(loop, pointer, slot);
        }
    }
    slot.idle = pointer.goes = pointer.is_new = false;
    play_hand(loop, pointer, slot);
    if (settings().traditional && known_press(pointer.here)) {
        pointer.limit.come();
    }
    const auto hand = hands_.leads(index) ? PressLimit::Hand::guessed : PressLimit::Hand::here;
    // Farther away than it is large, it has been led into a body that the operator's hand has gone around.
    if (hand == PressLimit::Hand::here && pointer.limit.returns() && is_free(pointer) &&
        glm::distance(slot.hand, slot.state.position) > slot.proxy->settings().radius) {
        slot.proxy->restart();
    }
    if (pointer.limit.binds(hand)) {
        draw_back(loop, pointer, slot, hand, hands_.is_outage(index));
        pointer.passivity.went(slot.hand);
    }
}

// The hand is gone: what it pressed is pressed less and less, then it touches nothing.
void TeleoperatorSide::let_go(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot) {
    pointer.holds = false;
    if (slot.idle) {
        return;
    }
    pointer.goes = true;
    slot.hand = pointer.hand;
    slot.hand_velocity = Vec3(0.0);
    draw_back(loop, pointer, slot, PressLimit::Hand::goes, false);
    if (pointer.limit.is_gone()) {
        slot.idle = true;
        pointer.goes = false;
    }
}

void TeleoperatorSide::play_hand(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot) {
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

PressLimit::In TeleoperatorSide::limited(const SessionLoop& loop, const auto& state,
                                         PressLimit::Hand hand) const {
    PressLimit::In in;
    in.hand = hand;
    in.force = glm::length(state.force);
    in.seconds = seconds_;
    const SessionLoop::Body* const under = state.contact_count > 0 ? loop.body(state.bodies[0]) : nullptr;
    if (under) {
        in.stiffness = std::max(1.0, spring_of(loop.scene().body(under->slot).material).steepest());
    }
    return in;
}
template PressLimit::In TeleoperatorSide::limited(const SessionLoop&, const ProxyState&,
                                                  PressLimit::Hand) const;
template PressLimit::In TeleoperatorSide::limited(const SessionLoop&, const ToolState&,
                                                  PressLimit::Hand) const;

void TeleoperatorSide::draw_back(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot,
                                 PressLimit::Hand hand, bool is_outage) {
    PressLimit::In in = limited(loop, slot.state, hand);
    in.is_outage = is_outage;
    in.own_force = known_press(pointer.here);
    pointer.limit.step(in);
    const ProxyMemory memory = slot.proxy->memory();
    const ProxyTick tick = slot.proxy->move(loop.scene(), slot.hand, seconds_);
    const bool touches = !slot.proxy->touching().empty();
    slot.proxy->recall(memory);
    const double depth = touches ? glm::distance(slot.hand, tick.position) : 0.0;
    if (depth > pointer.limit.depth()) {
        slot.hand = tick.position + shortened(slot.hand - tick.position, pointer.limit.depth());
        slot.hand_velocity = Vec3(0.0);
    }
    pointer.limit.applied(hand, depth);
}

// Where those are that hold something, and how deep those that nothing holds back.
void TeleoperatorSide::note_pressed(SessionLoop& loop) {
    for (std::size_t i = 0; i < share_.most(); ++i) {
        const SessionLoop::ProxySlot& slot = slot_of(loop, i);
        const ProxyState& state = slot.state;
        if (slot.proxy && pointers_[i].holds) {
            pointers_[i].kept = kept(loop, state, Pose{state.position, Quat(1.0, 0.0, 0.0, 0.0)});
        }
        const auto hand = hands_.leads(i) ? PressLimit::Hand::guessed : PressLimit::Hand::here;
        if (slot.proxy && pointers_[i].holds && !pointers_[i].limit.binds(hand)) {
            pointers_[i].limit.note(state.contact_count > 0 ? glm::distance(slot.hand, state.position) : 0.0);
        }
    }
    for (std::size_t i = 0; i < share_.most(max_tools); ++i) {
        const ToolSlot* const slot = tool_of(loop, i);
        if (slot && tools_[i].holds) {
            tools_[i].kept = kept(loop, slot->state, slot->state.pose);
        }
        if (slot && tools_[i].holds &&
            !tools_[i].limit.binds(PlayedHands::leads(*slot) ? PressLimit::Hand::guessed
                                                             : PressLimit::Hand::here)) {
            tools_[i].limit.note(slot->state.contact_count > 0 ? slot->stretch(slot->state.pose) : 0.0);
        }
    }
}

// Where the far hand may go so that no energy is made.
Vec3 TeleoperatorSide::passive_hand(Pointer& pointer, const SessionLoop::ProxySlot& slot) const {
    FarPassivity::In in;
    in.sample = pointer.here.sequence;
    in.hand = pointer.here.position;
    in.force = pointer.here.force;
    in.own_force = slot.state.force;
    in.seconds = seconds_;
    in.is_exact = pointer.playing == Playing::exact || pointer.playing == Playing::guessed;
    return pointer.passivity.hand(settings().passivity, settings().passive, in);
}

// Where a hand is lost, so that it can come back from there.
TeleoperatorSide::KeptPlace TeleoperatorSide::kept(const SessionLoop& loop, const auto& state,
                                                   const Pose& proxy) const {
    const SessionHandle on = state.contact_count > 0 ? state.bodies[0] : no_handle;
    if (const SessionLoop::Body* const under = loop.body(on)) {
        const Pose& pose = loop.scene().body(under->slot).pose;
        return {true, on, compose(inverse(pose), proxy)};
    }
    return {true, no_handle, proxy};
}
template TeleoperatorSide::KeptPlace TeleoperatorSide::kept(const SessionLoop&, const ToolState&,
                                                            const Pose&) const;

// Where the proxy of a hand that comes back begins: where it was, in the frame of what it pressed, and it is
// swept to the hand from there, so that no body is between the two. With a model a hand that is free at the
// operator begins where it is. Empty: so does this one.
std::optional<Pose> TeleoperatorSide::way_back(const SessionLoop& loop, const KeptPlace& kept,
                                               bool is_free) const {
    const SessionLoop::Body* const under = loop.body(kept.on);
    if (!kept.known || is_free || (kept.on != no_handle && !under)) {
        return std::nullopt;
    }
    if (!under) {
        return kept.proxy;
    }
    const Pose& pose = loop.scene().body(under->slot).pose;
    return compose(pose, kept.proxy);
}

// With a model: at the operator. Where nothing is in its way there, nothing may be on its way here.
bool TeleoperatorSide::is_free(const Pointer& pointer) const {
    return !settings().traditional && pointer.here.force == Vec3(0.0);
}
bool TeleoperatorSide::is_free(const Tool& tool) const {
    return !settings().traditional && tool.played.force == Vec3(0.0);
}

void TeleoperatorSide::come_back(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot) const {
    if (const std::optional<Pose> from = way_back(loop, pointer.kept, is_free(pointer))) {
        ProxyMemory memory;
        memory.position = from->position;
        memory.present = true;
        memory.hand = pointer.hand;
        slot.proxy->recall(memory);
    }
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
    note_pressed(loop);
    if (SampleAcknowledgements standing; hands_.acknowledges(standing)) {
        channel_.send(standing);
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
    channel_.set_own(own_terms(loop));
    statistics_.sample = newest_applied_;
    hands_.tell(statistics_);
    statistics_.discovery = telling_.counts();
    statistics_.load = telling_.load();
    channel_.end_tick(statistics_);
}

// Of what the operator must agree on with this side.
Terms TeleoperatorSide::own_terms(SessionLoop& loop) const {
    Terms terms = channel_.terms_of_settings();
    terms.bodies = loop.bodies_end();
    for (std::size_t i = 0; i < share_.most(); ++i) {
        terms.hands[i] = hand_terms(slot_of(loop, i));
    }
    for (std::size_t i = 0; i < share_.most(max_tools); ++i) {
        terms.hands[first_tool + i] = hand_terms(tool_of(loop, i));
    }
    return terms;
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
    sample.taken = told_energy(pointers_[index].passivity.taken());
    return sample;
}

}  // namespace tactus
