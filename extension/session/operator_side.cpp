#include "session/operator_side.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "core/haptics/nearest_surface.hpp"

namespace tactus {

OperatorSide::OperatorSide(const SessionSettings& session, const OperatorRoom& room,
                           const TeleopSettings& settings, Link& link, std::shared_ptr<TeleopPort> port,
                           const EndpointSettings& endpoint)
    : settings_(settings),
      room_(room),
      link_(link, endpoint),
      port_(std::move(port)),
      seconds_(to_seconds(session.period)),
      history_(room.most_tracked, room.samples),
      past_(room.samples),
      truths_(room.most_tracked),
      drags_(room.most_tracked),
      body_of_object_(session.most_bodies, no_handle),
      object_of_body_(session.most_bodies, no_object) {
    targets_.reserve(room.most_tracked);
    replay_truth_.reserve(room.most_tracked);
    for (std::size_t i = 0; i < std::min(room.pointers, pointers_.size()); ++i) {
        pointers_[i].felt.proxy = std::make_unique<Proxy>(session.most_parts, ProxySettings{});
    }
    if (room.replays) {
        SessionSettings alike = session;
        alike.history.ticks = 0;
        twin_ = std::make_unique<SessionLoop>(alike, nobody_looks_);
        const std::size_t count = room.samples / std::max<std::size_t>(1, room.samples_a_memento);
        mementos_.assign(count, LoopMemento(session.most_bodies, room.memento_bytes));
        memento_of_.assign(count, no_sample);
    }
}

// --- receiving

void OperatorSide::set_hands(SessionLoop& loop, Nanoseconds now) {
    take_settings(loop);
    link_.begin_tick(now);
    ++sample_;
    remember_hands(loop, now);
    receive(loop);
    statistics_.cost = {};
    targets_.clear();
    if (settings_.traditional) {
        follow_far_side(loop);
        return;
    }
    if (settings_.correction == Correction::none) {
        return;
    }
    const bool resimulates = settings_.derivation == Derivation::resimulate && twin_;
    if (!resimulates) {
        replaying_ = false;
    }
    if (resimulates && (replaying_ || begin_replay(loop))) {
        replay(loop);
        if (replayed_ + 1 == sample_ && !lands(loop, now)) {
            replaying_ = false;
            find_replayed_targets(loop);
        }
    } else if (any_news(loop) && !lands(loop, now)) {
        find_targets(loop, settings_.derivation);
    }
    if (!targets_.empty()) {
        correct(loop);
    }
}

void OperatorSide::take_settings(SessionLoop& loop) {
    if (!port_->settings.refresh()) {
        return;
    }
    const TeleopSettings before = std::exchange(settings_, port_->settings.front());
    link_.set_skew(settings_.skew);
    link_.set_scenario(settings_.traditional ? 2 : 4);
    if (settings_.leaving && !before.leaving) {
        link_.leave();
    }
    if (before.traditional != settings_.traditional) {
        forget_past();
        if (before.traditional) {
            begin_model(loop);
        }
    }
}

// What was modelled in the other scenario has nothing to do with this one.
void OperatorSide::forget_past() {
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        history_.forget(i);
        drags_[i] = {};
    }
    std::ranges::fill(memento_of_, no_sample);
    truth_at_ = no_sample;
    replaying_ = false;
    for (Pointer& pointer : pointers_) {
        pointer.active = pointer.apart = false;
        pointer.offset = Vec3(0.0);
        pointer.bridge = {};
    }
}

// The pointers go on from where the far side had them, so that a hand that presses goes on pressing.
void OperatorSide::begin_model(SessionLoop& loop) {
    for (std::size_t i = 0; i < most_proxies; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (slot.proxy && pointers_[i].far_sample != no_sample) {
            ProxyMemory memory;
            memory.position = pointers_[i].far_proxy;
            memory.present = true;
            memory.hand = slot.hand;
            slot.proxy->recall(memory);
        }
    }
}

void OperatorSide::remember_hands(SessionLoop& loop, Nanoseconds now) {
    Past& past = past_[sample_ % past_.size()];
    past.time = now;
    for (std::size_t i = 0; i < most_proxies; ++i) {
        const SessionLoop::ProxySlot& slot = loop.proxy(i);
        past.hands[i] = {slot.hand, slot.hand_velocity, slot.idle};
    }
}

void OperatorSide::receive(SessionLoop& loop) {
    notice_restart();
    restart_waits_ = restart_waits_ && !port_->discovery.put_restart();
    ObjectBinding binding;
    while (port_->bindings.try_pop(binding)) {
        bind(binding);
    }
    while (const Endpoint::Received* const received = link_.receive()) {
        notice_restart();
        restart_waits_ = restart_waits_ && !port_->discovery.put_restart();
        const Message& message = received->packet.message;
        if (const auto* const states = std::get_if<ObjectStates>(&message)) {
            take(*states, loop);
        } else if (const auto* const force = std::get_if<ForceSample>(&message)) {
            take(*force);
        } else if (const auto* const piece = std::get_if<DiscoveryFragment>(&message)) {
            if (!restart_waits_) {
                port_->discovery.put(*piece);
            }
        } else if (const auto* const removal = std::get_if<ObjectRemoval>(&message)) {
            if (!restart_waits_) {
                port_->discovery.put(*removal);
            }
        }
    }
}

void OperatorSide::bind(const ObjectBinding& binding) {
    if (binding.object >= body_of_object_.size()) {
        return;
    }
    const SessionHandle before = std::exchange(body_of_object_[binding.object], binding.body);
    if (before < object_of_body_.size()) {
        object_of_body_[before] = no_object;
    }
    if (binding.body < object_of_body_.size()) {
        object_of_body_[binding.body] = binding.object;
    }
    for (const SessionHandle body : {before, binding.body}) {
        if (body < truths_.size()) {
            truths_[body] = {};
            drags_[body] = {};
            history_.forget(body);
        }
    }
}

void OperatorSide::notice_restart() {
    const std::uint64_t epoch = link_.peer_epoch();
    if (epoch != 0 && epoch != peer_epoch_ && std::exchange(peer_epoch_, epoch) != 0) {
        forget_far_side();
    }
}

// Another start of the far side: nothing that the last one said holds.
void OperatorSide::forget_far_side() {
    std::ranges::fill(truths_, Truth{});
    std::ranges::fill(body_of_object_, no_handle);
    std::ranges::fill(object_of_body_, no_object);
    for (Pointer& pointer : pointers_) {
        pointer.far_force = Vec3(0.0);
        pointer.far_sample = no_sample;
    }
    truth_at_ = no_sample;
    replaying_ = false;
    restart_waits_ = true;
}

void OperatorSide::acknowledge() {
    constexpr int most_a_tick = 8;
    DiscoveryAcknowledgement acknowledgement;
    for (int i = 0; i < most_a_tick && port_->discovery.next_acknowledgement(acknowledgement); ++i) {
        link_.send(acknowledgement);
    }
}

// Newest wins, for each object. A sample that has not been sent yet is none of ours.
void OperatorSide::take(const ObjectStates& states, SessionLoop& loop) {
    const SampleSequence sample = states.newest_operator_sample;
    if (sample >= sample_) {
        return;
    }
    if (sample != no_sample) {
        statistics_.round_trip = static_cast<double>(sample_ - sample) * seconds_;
    }
    for (std::size_t i = 0; i < states.count; ++i) {
        const ObjectState& state = states.states[i];
        const SessionHandle body =
            state.object < body_of_object_.size() ? body_of_object_[state.object] : no_handle;
        if (body >= truths_.size() || !loop.body(body)) {
            ++statistics_.unknown_objects;
            continue;
        }
        Truth& truth = truths_[body];
        if (truth.true_at != 0 && states.true_at <= truth.true_at) {
            ++statistics_.stale_states;
            continue;
        }
        truth.sample_before = truth.sample;
        truth.before = truth.motion;
        truth.sample = sample;
        truth.true_at = states.true_at;
        truth.motion = {state.pose, state.linear_velocity, state.angular_velocity};
        truth.fresh = true;
    }
}

void OperatorSide::take(const ForceSample& force) {
    if (force.pointer >= most_proxies || force.newest_operator_sample > sample_) {
        return;
    }
    Pointer& pointer = pointers_[force.pointer];
    if (force.newest_operator_sample < pointer.far_sample) {
        ++statistics_.stale_states;
        return;
    }
    pointer.far_sample = force.newest_operator_sample;
    pointer.far_force = force.force;
    pointer.far_proxy = force.proxy;
    pointer.far_object = force.object;
    statistics_.round_trip = static_cast<double>(sample_ - force.newest_operator_sample) * seconds_;
}

// Traditional: bodies are shown where the far side last said.
void OperatorSide::follow_far_side(SessionLoop& loop) {
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        if (std::exchange(truths_[i].fresh, false) && loop.body(static_cast<SessionHandle>(i))) {
            loop.put_right(static_cast<SessionHandle>(i), truths_[i].motion, true);
        }
    }
}

// --- what is true now

bool OperatorSide::tracks(SessionLoop& loop, std::size_t body) const {
    return body < truths_.size() && loop.body(static_cast<SessionHandle>(body));
}

// Whether the far side said something that the model did not know.
bool OperatorSide::is_news(SessionLoop& loop, std::size_t body) const {
    const Truth& truth = truths_[body];
    if (!truth.fresh || !tracks(loop, body)) {
        return false;
    }
    const bool moves = loop.body(static_cast<SessionHandle>(body))->motion == Motion::Dynamic;
    if (truth.sample == no_sample && !nothing_is_touched(loop)) {
        return false;  // from before the first sample of a hand that has been at work since
    }
    if (settings_.derivation == Derivation::none || truth.sample == no_sample) {
        return poses_differ(truth.motion.pose, loop.motion(static_cast<SessionHandle>(body)).pose,
                            settings_.threshold);
    }
    const BodyMotion* const then = history_.at(body, truth.sample);
    if (!then) {
        return false;
    }
    return settings_.correction == Correction::pose || !moves
               ? poses_differ(truth.motion.pose, then->pose, settings_.threshold)
               : differs(truth.motion, *then, settings_.threshold);
}

bool OperatorSide::nothing_is_touched(SessionLoop& loop) const {
    for (std::size_t i = 0; i < most_proxies; ++i) {
        const SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (slot.present() && !slot.proxy->touching().empty()) {
            return false;
        }
    }
    return true;
}

DerivationInput OperatorSide::derivation_input(const Truth& truth, const BodyMotion& then,
                                               const BodyMotion& now) const {
    DerivationInput in;
    in.received = truth.motion;
    in.own_then = then;
    in.own_now = now;
    in.seconds = static_cast<double>(sample_ - 1 - truth.sample) * seconds_;
    if (truth.sample_before != no_sample && truth.sample > truth.sample_before) {
        const double between = static_cast<double>(truth.sample - truth.sample_before) * seconds_;
        in.linear_acceleration = (truth.motion.linear_velocity - truth.before.linear_velocity) / between;
        in.angular_acceleration = (truth.motion.angular_velocity - truth.before.angular_velocity) / between;
    }
    return in;
}

bool OperatorSide::any_news(SessionLoop& loop) const {
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        if (is_news(loop, i)) {
            return true;
        }
    }
    return false;
}

void OperatorSide::find_targets(SessionLoop& loop, Derivation derivation) {
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        const bool news = is_news(loop, i);
        truths_[i].fresh = false;
        if (!news) {
            continue;
        }
        const auto handle = static_cast<SessionHandle>(i);
        const BodyMotion now = loop.motion(handle);
        const BodyMotion* const then = history_.at(i, truths_[i].sample);
        const Derivation how = truths_[i].sample == no_sample ? Derivation::none : derivation;
        Target target{handle, derive(how, derivation_input(truths_[i], then ? *then : now, now)), {}};
        if (settings_.correction == Correction::pose) {
            target.motion.linear_velocity = now.linear_velocity;
            target.motion.angular_velocity = now.angular_velocity;
        }
        history_.carry(i, truths_[i].sample, sample_ - 1, now, target.motion);
        targets_.push_back(target);
    }
}

// --- sending

void OperatorSide::report(SessionLoop& loop, Nanoseconds now) {
    if (!settings_.traditional) {
        remember(loop);
    }
    for (std::size_t i = 0; i < most_proxies; ++i) {
        if (loop.proxy(i).present()) {
            send_sample(loop, i, now);
        }
    }
    acknowledge();
    link_.end_tick();
    statistics_.sample = sample_;
    statistics_.link = link_.statistics();
    port_->statistics.publish(statistics_);
}

void OperatorSide::remember(SessionLoop& loop) {
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        if (tracks(loop, i)) {
            history_.set(i, sample_, loop.motion(static_cast<SessionHandle>(i)));
        }
    }
    if (twin_ && settings_.derivation == Derivation::resimulate && sample_ % room_.samples_a_memento == 0) {
        const std::size_t index = sample_ / room_.samples_a_memento % mementos_.size();
        memento_of_[index] = loop.save(mementos_[index]) ? sample_ : no_sample;
    }
}

// What the far side needs to do the same: the true hand, and what it presses bodies with.
void OperatorSide::send_sample(SessionLoop& loop, std::size_t index, Nanoseconds now) {
    const SessionLoop::ProxySlot& slot = loop.proxy(index);
    Pointer& pointer = pointers_[index];
    const DeviceSample device = loop.device_sample(slot.description.device);
    OperatorSample sample;
    sample.sequence = sample_;
    sample.time = link_.local_time(now);
    sample.pointer = static_cast<std::uint16_t>(index);
    sample.connected = device.connected;
    sample.buttons = device.buttons;
    sample.position = slot.hand;
    sample.velocity = slot.hand_velocity;
    sample.force = settings_.traditional ? Vec3(0.0) : slot.force;
    if (settings_.deadband.enabled && pointer.sent_count > 0 &&
        now - pointer.sent_at < settings_.deadband.longest_silence) {
        const OperatorSample& last = pointer.sent[0];
        const Vec3 guessed = guessed_position(last.position, last.velocity,
                                              static_cast<double>(sample_ - last.sequence) * seconds_);
        if (!position_needs_sending(settings_.deadband, guessed, sample.position, sample.velocity) &&
            !(uses_force(settings_.control) &&
              force_needs_sending(settings_.deadband, last.force, sample.force)) &&
            sample.buttons == last.buttons) {
            return;
        }
    }
    if (!settings_.traditional && settings_.control == ControlScheme::position_force_relative) {
        find_nearest(loop, slot, sample);
    }
    std::shift_right(pointer.sent.begin(), pointer.sent.end(), 1);
    pointer.sent[0] = sample;
    pointer.sent_count = std::min(pointer.sent_count + 1, pointer.sent.size());
    pointer.sent_at = now;
    OperatorSamples message;
    message.count = static_cast<std::uint16_t>(
        std::min<std::size_t>(pointer.sent_count, std::max(1u, settings_.repeats)));
    std::copy_n(pointer.sent.begin(), message.count, message.samples.begin());
    link_.send(message);
}

void OperatorSide::find_nearest(SessionLoop& loop, const SessionLoop::ProxySlot& slot,
                                OperatorSample& sample) const {
    double near = settings_.stand_in.near + slot.description.settings.radius;
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        const SessionLoop::Body* const body = loop.body(static_cast<SessionHandle>(i));
        if (!body || body->motion == Motion::Static || object_of_body_[i] == no_object) {
            continue;
        }
        const NearestSurface nearest =
            nearest_surface(loop.scene(), body->slot, slot.proxy->position(), near);
        if (nearest.distance < near) {
            near = nearest.distance;
            sample.nearest_object = object_of_body_[i];
            sample.position_in_object = to_local(loop.scene().body(body->slot).pose, slot.hand);
        }
    }
}

}  // namespace tactus
