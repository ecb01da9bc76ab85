#include "session/teleoperator_side.hpp"

#include <algorithm>
#include <utility>

namespace tactus {

namespace {

// Where a body has come to rest is said so many ticks longer: some of it is lost.
constexpr std::uint64_t linger = 200;

// Nobody sees such a difference in a body that moves (unit: meters, radians).
constexpr double seen_position = 1e-3;
constexpr double seen_angle = 0.02;

}  // namespace

TeleoperatorSide::TeleoperatorSide(const SessionSettings& session, const TeleopSettings& settings, Link& link,
                                   std::shared_ptr<TeleopPort> port, const EndpointSettings& endpoint)
    : settings_(settings),
      link_(link, endpoint),
      port_(std::move(port)),
      seconds_(to_seconds(session.period)),
      moved_at_(session.most_bodies),
      told_(session.most_bodies) {
    set_buffers();
}

void TeleoperatorSide::set_buffers() {
    JitterBufferSettings buffer;
    buffer.depth = settings_.buffer_depth;
    buffer.sparse = settings_.deadband.enabled;
    buffer.seconds = seconds_;
    peer_period_ = link_.statistics().peer_hello.period;
    buffer.sample_seconds = peer_period_ > 0 ? to_seconds(peer_period_) : seconds_;
    buffer.guess_seconds = 2.0 * to_seconds(settings_.deadband.longest_silence);
    for (Pointer& pointer : pointers_) {
        pointer.buffer.set_settings(buffer);
    }
}

void TeleoperatorSide::set_hands(SessionLoop& loop, Nanoseconds now) {
    link_.begin_tick(now);
    take_orders();
    ++tick_;
    receive();
    if (link_.statistics().peer_hello.period != peer_period_) {
        set_buffers();
    }
    if (!link_.hears_peer()) {
        release_hands();
    }
    for (std::size_t i = 0; i < most_proxies; ++i) {
        if (SessionLoop::ProxySlot& slot = loop.proxy(i); slot.proxy) {
            play(loop, pointers_[i], slot);
        }
    }
}

void TeleoperatorSide::take_orders() {
    if (port_->settings.refresh()) {
        const bool left = std::exchange(settings_, port_->settings.front()).leaving;
        link_.set_skew(settings_.skew);
        link_.set_scenario(settings_.traditional ? 2 : 4);
        if (settings_.leaving && !left) {
            link_.leave();
        }
        set_buffers();
    }
    while (PreparedDiscovery* const announced = port_->announced.front()) {
        discovery_.announce(*announced);
        port_->released.try_push(std::move(announced->content));
        port_->announced.pop();
    }
    ObjectId gone = no_object;
    while (port_->withdrawn.try_pop(gone)) {
        std::shared_ptr<const std::vector<std::byte>> content;
        discovery_.withdraw(gone, content);
        port_->released.try_push(std::move(content));
    }
}

void TeleoperatorSide::receive() {
    notice_restart();
    while (const Endpoint::Received* const received = link_.receive()) {
        notice_restart();
        const Message& message = received->packet.message;
        if (const auto* const samples = std::get_if<OperatorSamples>(&message)) {
            for (std::size_t i = 0; i < samples->count; ++i) {
                if (samples->samples[i].pointer < most_proxies) {
                    pointers_[samples->samples[i].pointer].buffer.insert(samples->samples[i]);
                }
            }
        } else if (const auto* const known = std::get_if<DiscoveryAcknowledgement>(&message)) {
            discovery_.take(*known);
        }
    }
}

void TeleoperatorSide::notice_restart() {
    if (link_.peer_epoch() != peer_epoch_) {
        peer_epoch_ = link_.peer_epoch();
        release_hands();
        discovery_.restart();
    }
}

// Nobody is there: the pointers touch nothing, and what comes next is a new beginning.
void TeleoperatorSide::release_hands() {
    newest_applied_ = no_sample;
    for (Pointer& pointer : pointers_) {
        if (pointer.buffer.counts().exact > 0) {
            pointer.buffer.restart();
        }
        pointer.holds = false;
    }
}

void TeleoperatorSide::describe(Nanoseconds now) {
    constexpr int most_a_tick = 2;
    constexpr Nanoseconds soonest = 200'000'000;
    discovery_.set_repeat_after(
        std::max(soonest, static_cast<Nanoseconds>(1.5 * link_.clock().figures().mean_delay)));
    const DiscoveryCounts& counts = discovery_.counts();
    link_.set_world(counts.waiting + counts.known + counts.refused + counts.no_room, settings_.gravity);
    Message message;
    for (int i = 0; i < most_a_tick && link_.hears_peer() && discovery_.next(now, message); ++i) {
        link_.send(message);
    }
}

void TeleoperatorSide::play(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot) {
    if (pointer.buffer.play(pointer.played) == Playing::waiting || !pointer.played.connected) {
        slot.idle = true;
        pointer.holds = false;
        return;
    }
    if (!pointer.holds) {
        pointer.hand = pointer.played.position;
        pointer.holds = true;
    }
    slot.idle = false;
    newest_applied_ = std::max(newest_applied_, pointer.played.sequence);
    pointer.hand = stand_in_hand(settings_.control, settings_.stand_in, stand_in_input(loop, pointer, slot));
    slot.hand = pointer.hand;
    slot.hand_velocity = pointer.played.velocity;
}

StandInInput TeleoperatorSide::stand_in_input(SessionLoop& loop, const Pointer& pointer,
                                              const SessionLoop::ProxySlot& slot) const {
    StandInInput in;
    in.hand = pointer.played.position;
    in.velocity = pointer.played.velocity;
    in.force = pointer.played.force;
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
            in.in_contact = true;
            in.stiffness = body.material.stiffness;
            in.own_proxy = to_parent(body.pose, to_local(body.previous, slot.state.position));
        }
    }
    return in;
}

void TeleoperatorSide::report(SessionLoop& loop, Nanoseconds now) {
    send_states(loop, now);
    for (std::size_t i = 0; i < most_proxies && settings_.traditional; ++i) {
        if (pointers_[i].holds && loop.proxy(i).present()) {
            send_force(loop, i, now);
        }
    }
    describe(now);
    link_.end_tick();
    statistics_.sample = newest_applied_;
    statistics_.buffer = pointers_[0].buffer.counts();
    statistics_.buffer_depth = pointers_[0].buffer.depth();
    statistics_.link = link_.statistics();
    statistics_.discovery = discovery_.counts();
    port_->statistics.publish(statistics_);
}

// What moves is said often; with a deadband, when it goes on otherwise than was said.
bool TeleoperatorSide::state_needs_sending(SessionLoop& loop, std::size_t body, Nanoseconds now) const {
    const Told& told = told_[body];
    if (moved_at_[body] == 0 || tick_ - moved_at_[body] >= linger) {
        return false;
    }
    const auto handle = static_cast<SessionHandle>(body);
    if (!settings_.deadband.enabled || told.tick == 0 || loop.asleep(handle) != told.asleep ||
        now - told.time >= settings_.deadband.longest_silence) {
        return true;
    }
    DerivationInput since;
    since.received = told.motion;
    since.seconds = static_cast<double>(tick_ - told.tick) * seconds_;
    DeadbandSettings band = settings_.deadband;
    if (settings_.traditional) {
        // What is only seen may be off by more.
        band.position = std::max(band.position, seen_position);
        band.angle = std::max(band.angle, seen_angle);
    }
    return motion_needs_sending(band, derive(Derivation::velocity, since), loop.motion(handle));
}

// States by need: what moves often, everything now and then.
void TeleoperatorSide::send_states(SessionLoop& loop, Nanoseconds now) {
    for (std::size_t i = 0; i < moved_at_.size(); ++i) {
        if (const auto handle = static_cast<SessionHandle>(i); loop.body(handle) && !loop.asleep(handle)) {
            moved_at_[i] = tick_;
        }
    }
    const bool everything = tick_ % std::max(1u, settings_.refresh_every) == 0;
    if (!everything && tick_ % std::max(1u, settings_.states_every) != 0) {
        return;
    }
    ObjectStates message;
    message.true_at = link_.local_time(now);
    message.newest_operator_sample = newest_applied_;
    for (std::size_t i = 0; i < moved_at_.size(); ++i) {
        const auto handle = static_cast<SessionHandle>(i);
        const SessionLoop::Body* const body = loop.body(handle);
        if (!body || (!everything && !state_needs_sending(loop, i, now))) {
            continue;
        }
        const BodyMotion motion = loop.motion(handle);
        told_[i] = {motion, tick_, now, loop.asleep(handle)};
        message.states[message.count++] = {static_cast<ObjectId>(handle), loop.asleep(handle), motion.pose,
                                           motion.linear_velocity, motion.angular_velocity};
        if (message.count == ObjectStates::most) {
            link_.send(message);
            message.count = 0;
        }
    }
    if (message.count > 0) {
        link_.send(message);
    }
}

void TeleoperatorSide::send_force(SessionLoop& loop, std::size_t index, Nanoseconds now) {
    const ProxyState& state = loop.proxy(index).state;
    Pointer& pointer = pointers_[index];
    if (!force_needs_sending(settings_.deadband, pointer.force_sent, state.force) &&
        now - pointer.force_sent_at < settings_.deadband.longest_silence) {
        return;
    }
    ForceSample message;
    message.pointer = static_cast<std::uint16_t>(index);
    message.true_at = link_.local_time(now);
    message.newest_operator_sample = pointer.played.sequence;
    message.force = state.force;
    message.proxy = state.position;
    message.object = state.contact_count > 0 ? static_cast<ObjectId>(state.bodies[0]) : no_object;
    if (link_.send(message)) {
        pointer.force_sent = state.force;
        pointer.force_sent_at = now;
    }
}

}  // namespace tactus
