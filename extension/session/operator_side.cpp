#include "session/operator_side.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "core/haptics/nearest_surface.hpp"

namespace tactus {

namespace {

// A force below this is none (unit: newtons).
constexpr double no_force = 1e-9;

// Of a pointer that rests on nothing that says otherwise (unit: newtons per meter).
constexpr double usual_stiffness = 500.0;

}  // namespace

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

// --- re-simulation

// False where there is nothing to replay, or no past to start from.
bool OperatorSide::begin_replay(SessionLoop& loop) {
    learn_drags(loop);
    const bool news = any_news(loop);
    SampleSequence newest = no_sample;
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        newest = truths_[i].fresh ? std::max(newest, truths_[i].sample) : newest;
    }
    if (news && newest == no_sample) {
        return false;  // nothing to replay: the far side has heard of no hand yet
    }
    if (!news) {
        std::ranges::for_each(truths_, [](Truth& truth) { truth.fresh = false; });
        return false;
    }
    std::size_t start = mementos_.size();
    for (std::size_t i = 0; i < mementos_.size(); ++i) {
        const bool fits = memento_of_[i] != no_sample && memento_of_[i] <= newest &&
                          sample_ - memento_of_[i] < past_.size();
        if (fits && (start == mementos_.size() || memento_of_[i] > memento_of_[start])) {
            start = i;
        }
    }
    if (start == mementos_.size() || !twin_->restore(mementos_[start])) {
        return false;
    }
    replaying_ = true;
    replayed_ = memento_of_[start];
    truth_at_ = newest;
    replay_truth_.clear();
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        if (truths_[i].fresh && tracks(loop, i)) {
            replay_truth_.push_back({static_cast<SessionHandle>(i), truths_[i].motion, {}});
        }
        truths_[i].fresh = false;
    }
    ++statistics_.replays;
    return true;
}

// The model's past since the last truth that was put in came from that truth alone.
void OperatorSide::learn_drags(SessionLoop& loop) {
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        const Truth& truth = truths_[i];
        const BodyMotion* const model = history_.at(i, truth.sample);
        if (truth.fresh && model && tracks(loop, i) && truth_at_ != no_sample && truth.sample > truth_at_) {
            drags_[i].learn(settings_.drag, truth.motion.linear_velocity, model->linear_velocity,
                            static_cast<double>(truth.sample - truth_at_) * seconds_);
        }
    }
}

void OperatorSide::apply_drags(SessionLoop& loop) const {
    for (std::size_t i = 0; i < drags_.size(); ++i) {
        if (drags_[i].value() != 0.0 && loop.body(static_cast<SessionHandle>(i))) {
            const auto handle = static_cast<SessionHandle>(i);
            loop.accelerate(handle,
                            drags_[i].acceleration(settings_.drag, loop.motion(handle).linear_velocity));
        }
    }
}

void OperatorSide::put_in_truth() {
    for (const Target& truth : replay_truth_) {
        twin_->put_right(truth.body, truth.motion, true);
    }
    replay_truth_.clear();
}

void OperatorSide::replay_tick(SessionLoop& loop) {
    twin_->begin_replay_tick();
    if (replayed_ == truth_at_) {
        put_in_truth();
    }
    const Past& past = past_[++replayed_ % past_.size()];
    for (std::size_t i = 0; i < most_proxies; ++i) {
        SessionLoop::ProxySlot& slot = twin_->proxy(i);
        slot.hand = past.hands[i].position;
        slot.hand_velocity = past.hands[i].velocity;
        slot.idle = past.hands[i].idle;
    }
    apply_drags(*twin_);
    twin_->end_replay_tick(past.time);
    if (replayed_ <= truth_at_) {
        return;
    }
    // What comes in later is compared with this past, and starts from it.
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        if (tracks(loop, i)) {
            history_.set(i, replayed_, twin_->motion(static_cast<SessionHandle>(i)));
        }
    }
    if (replayed_ % room_.samples_a_memento == 0) {
        const std::size_t index = replayed_ / room_.samples_a_memento % mementos_.size();
        memento_of_[index] = twin_->save(mementos_[index]) ? replayed_ : no_sample;
    }
}

void OperatorSide::replay(SessionLoop& loop) {
    for (std::uint32_t i = 0; i < settings_.replay_steps && replayed_ + 1 < sample_; ++i) {
        replay_tick(loop);
    }
}

void OperatorSide::find_replayed_targets(SessionLoop& loop) {
    twin_->begin_replay_tick();
    if (replayed_ == truth_at_) {
        put_in_truth();
    }
    for (std::size_t i = 0; i < truths_.size(); ++i) {
        const auto handle = static_cast<SessionHandle>(i);
        if (!tracks(loop, i) || !twin_->body(handle)) {
            continue;
        }
        const BodyMotion replayed = twin_->motion(handle);
        const BodyMotion now = loop.motion(handle);
        if (differs(replayed, now, settings_.threshold)) {
            targets_.push_back({handle, replayed, twin_->scene().body(twin_->body(handle)->slot).previous});
        }
    }
}

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
    for (const Contact& contact : pressing.touching()) {
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
            slot.state.hand = slot.hand;
            slot.state.position = pointer.far_sample != no_sample ? pointer.far_proxy : slot.hand;
            slot.state.force = link_.hears_peer() ? pointer.far_force : Vec3(0.0);
            continue;
        }
        feel(loop, pointer, slot, now);
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
    sample.time = now;
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
