#include "session/operator_side.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "session/hand_terms.hpp"

namespace tactus {

OperatorSide::OperatorSide(const SessionSettings& session, const OperatorRoom& room,
                           const TeleopSettings& settings, Link& link, std::shared_ptr<TeleopPort> port,
                           const EndpointSettings& endpoint)
    : room_(room),
      channel_(settings, link, std::move(port), endpoint),
      samples_({std::max(1u, settings.repeats) - 1, first_tool + max_tools, session.period}),
      seconds_(to_seconds(session.period)),
      truths_(session.max_bodies, room.max_tracked),
      past_(room.max_tracked, room.samples),
      resimulator_(session, room.samples, room.samples_a_memento, room.memento_bytes, room.replays),
      estimates_(room.max_tracked, ParameterEstimate(settings.estimate)),
      residuals_(room.max_tracked),
      alone_since_(room.max_tracked, 0),
      filters_(session.max_bodies),
      found_(session.max_bodies),
      body_of_object_(session.max_bodies, no_handle),
      object_of_body_(session.max_bodies, no_object) {
    pupils_.reserve(room.max_tracked);
    targets_.reserve(session.max_bodies);
    news_.reserve(session.max_bodies);
    hands_.reserve(max_proxies + max_tools);
    for (std::size_t i = 0; i < std::min(room.pointers, pointers_.size()); ++i) {
        pointers_[i].carried.take_room(session.max_parts);
    }
}

void OperatorSide::set_hands(SessionLoop& loop, Nanoseconds now) {
    changed_ = loop.take_touch_change();
    for (std::size_t i = 0; i < max_proxies; ++i) {
        changed_ = changed_ || has_leapt(loop, loop.proxy(i).state);
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        changed_ = changed_ || (loop.tool(i) && has_leapt(loop, loop.tool(i)->state));
    }
    if (channel_.begin_tick(now)) {
        take_settings(loop);
    }
    limits_ = settings().limits;
    limits_.slew = std::min(limits_.slew, max_unexplained_step / seconds_);
    ++sample_;
    hold_back_hands(loop);
    round_hands(loop);
    hold_fixed_tools(loop);
    round_tools(loop);
    past_.note_hands(loop, sample_, now);
    hands_.clear();
    for (std::size_t i = 0; i < max_proxies; ++i) {
        if (const SessionLoop::ProxySlot& slot = loop.proxy(i); slot.present()) {
            hands_.push_back(slot.hand);
        }
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (const ToolSlot* const slot = loop.tool(i); slot && slot->hand.holds) {
            hands_.push_back(slot->hand.goal.position);
        }
    }
    receive(loop, now);
    take_over_found(loop);
    set_residuals(loop);
    statistics_.spent += std::exchange(statistics_.cost, {});
    targets_.clear();
    corrected_ = false;
    if (settings().traditional || channel_.disagreement().whole) {
        resimulator_.stop();
        follow_far_side(loop);
    } else if (settings().correction != Correction::none) {
        find_targets(loop, now);
        if (!targets_.empty()) {
            correct(loop, now);
        }
    }
}

// Until the model is whole a hand touches nothing, and is absent at the far side.
bool OperatorSide::waits_for_model() const {
    return described_ == FirstDescription::begun && !settings().traditional;
}

// Nor does one that cannot work together with the far side's.
bool OperatorSide::is_held_back(std::size_t hand) const {
    return waits_for_model() || !channel_.works_together(hand);
}

void OperatorSide::hold_back_hands(SessionLoop& loop) {
    for (std::size_t i = 0; i < max_proxies; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        const bool idle = is_held_back(i);
        changed_ = changed_ || (slot.proxy && slot.idle != idle);
        slot.idle = idle;
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (ToolSlot* const slot = loop.tool(i)) {
            slot->hand.holds = slot->hand.holds && !is_held_back(first_tool + i);
        }
    }
}

// What the far side is told of a hand is rounded (as_sent): the model is touched by the same hand.
void OperatorSide::round_hands(SessionLoop& loop) const {
    const Pose& frame = settings().frame;
    for (std::size_t i = 0; i < max_proxies; ++i) {
        if (SessionLoop::ProxySlot& slot = loop.proxy(i); slot.present()) {
            slot.hand = to_parent(frame, position_as_sent(to_local(frame, slot.hand)));
            slot.hand_velocity =
                direction_to_parent(frame, velocity_as_sent(direction_to_local(frame, slot.hand_velocity)));
        }
    }
}

void OperatorSide::take_settings(SessionLoop& loop) {
    samples_.set_max_repeats(std::max(1u, settings().repeats) - 1);
    const bool was_traditional = channel_.before().traditional;
    if (was_traditional != settings().traditional) {
        changed_ = true;
        forget_past();
        if (was_traditional) {
            begin_model(loop);
        }
    }
}

// What was modelled in the other scenario has nothing to do with this one.
void OperatorSide::forget_past() {
    resimulator_.forget();
    for (std::uint32_t place = 0; place < truths_.places(); ++place) {
        forget_place(place);
    }
    for (Pointer& pointer : pointers_) {
        pointer.carried.forget();
    }
}

// The pointers go on from where the far side had them, so that a hand that presses goes on pressing.
void OperatorSide::begin_model(SessionLoop& loop) {
    for (std::size_t i = 0; i < max_proxies; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (slot.proxy && traditional_.far(i).sample != no_sample) {
            ProxyMemory memory;
            memory.position = traditional_.far(i).proxy;
            memory.present = true;
            memory.hand = slot.hand;
            slot.proxy->recall(memory);
        }
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        ToolSlot* const slot = loop.tool(i);
        // Where a robot has it, it may be in a body of the model.
        if (slot && !settings().robot && traditional_.far_tool(i).sample != no_sample) {
            ToolMemory memory;
            memory.pose = traditional_.far_tool(i).tool;
            memory.present = true;
            slot->proxy.recall(memory, loop.scene());
        }
    }
}

// --- receiving

void OperatorSide::receive(SessionLoop& loop, Nanoseconds now) {
    start_over_if_peer_has();
    ObjectBinding binding;
    while (channel_.port().bindings.try_pop(binding)) {
        if (channel_.port().tap) {
            channel_.port().tap->took(binding);
        }
        bind(binding);
    }
    while (const Packet* const packet = channel_.receive()) {
        const Message* const message = &packet->message;
        start_over_if_peer_has();
        DiscoveryReceiver& discovery = channel_.port().discovery;
        if (const auto* const states = std::get_if<ObjectStates>(message)) {
            take(*states, packet->header.sequence, loop);
        } else if (const auto* const forces = std::get_if<ForceSamples>(message)) {
            for (std::size_t i = 0; i < forces->count; ++i) {
                take(forces->samples[i]);
            }
        } else if (const auto* const wrenches = std::get_if<WrenchSamples>(message)) {
            for (std::size_t i = 0; i < wrenches->count; ++i) {
                take(wrenches->samples[i]);
            }
        } else if (const auto* const ghosts = std::get_if<Ghosts>(message)) {
            ghosts_.take(*ghosts, packet->header.sequence, settings().frame, now);
        } else if (const auto* const estimates = std::get_if<ObjectEstimates>(message)) {
            take(*estimates, packet->header.sequence);
        } else if (const auto* const known = std::get_if<SampleAcknowledgements>(message)) {
            take(*known);
        } else if (const auto* const piece = std::get_if<DiscoveryFragment>(message)) {
            if (!restart_waits_) {
                discovery.put(*piece, packet->header.sequence);
            }
        } else if (const auto* const removal = std::get_if<ObjectRemoval>(message)) {
            if (!restart_waits_) {
                discovery.put(*removal);
            }
        }
    }
}

void OperatorSide::start_over_if_peer_has() {
    if (channel_.peer_has_started() && channel_.peer_has_restarted()) {
        forget_far_side();
    }
    restart_waits_ = restart_waits_ && !channel_.port().discovery.put_restart();
}

// Another start of the far side: nothing that the last one said holds.
void OperatorSide::forget_far_side() {
    truths_.forget_all();
    std::ranges::fill(filters_, PoseFilter{});
    std::ranges::fill(found_, Found{});
    news_.clear();
    eyes_ = {};
    ghosts_.forget();
    std::ranges::fill(body_of_object_, no_handle);
    std::ranges::fill(object_of_body_, no_object);
    traditional_.forget();
    forget_past();
    samples_.restart();
    for (Pointer& pointer : pointers_) {
        pointer.sent = {};
    }
    for (Tool& tool : tools_) {
        tool.sent = {};
    }
    restart_waits_ = true;
}

void OperatorSide::bind(const ObjectBinding& binding) {
    if (binding.object == no_object) {
        described_ =
            binding.body == description_is_whole.body ? FirstDescription::whole : FirstDescription::begun;
        return;
    }
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
        if (truths_.knows(body)) {
            forget_body(body);
        }
    }
}

void OperatorSide::forget_body(SessionHandle body) {
    if (const std::uint32_t place = truths_.place_of(body); place != TruthStore::no_place) {
        forget_place(place);
    }
    truths_.forget(body);
    filters_[body].forget();
    found_[body] = {};
    std::erase(news_, body);
}

void OperatorSide::forget_place(std::uint32_t place) {
    past_.forget(place);
    estimates_[place].forget(settings().estimate);
    residuals_[place] = {};
    alone_since_[place] = sample_;
}

SessionHandle OperatorSide::body_of(ObjectId object) const {
    return object < body_of_object_.size() ? body_of_object_[object] : no_handle;
}

// A sample that has not been sent yet is none of ours.
void OperatorSide::take(const ObjectStates& states, std::uint64_t packet, SessionLoop& loop) {
    const SampleSequence sample = states.newest_operator_sample;
    if (sample >= sample_) {
        return;
    }
    note_answer(sample);
    for (std::size_t i = 0; i < states.count; ++i) {
        const SessionHandle body = body_of(states.states[i].object);
        if (loop.body(body) && truths_.is_newer(body, packet)) {
            note_forbidden(loop, body, compose(settings().frame, states.states[i].pose));
        }
    }
    for (std::size_t i = 0; i < states.count; ++i) {
        const ObjectState& state = states.states[i];
        const SessionHandle body = body_of(state.object);
        const SessionLoop::Body* const known = loop.body(body);
        if (!known) {
            ++statistics_.unknown_objects;
            continue;
        }
        const BodyMotion motion = to_parent(
            settings().frame, BodyMotion{state.pose, state.linear_velocity, state.angular_velocity});
        if (!truths_.is_newer(body, packet) ||
            !truths_.take(body, sample, packet, believed(loop, body, sample, motion))) {
            ++statistics_.stale_states;
            continue;
        }
        if (known->motion != Motion::Static) {
            SessionHandle evicted = no_handle;
            const bool had_none = truths_.place_of(body) == TruthStore::no_place;
            const std::uint32_t place = truths_.give_place(body, hands_, evicted);
            if (had_none && place != TruthStore::no_place) {
                forget_place(place);
            }
            statistics_.without_past += place == TruthStore::no_place ? 1 : 0;
            statistics_.beyond_history += is_beyond_history(sample) ? 1 : 0;
        }
    }
}

// Only the first answer to a sample tells how long it takes: while no hand is played, none follows.
void OperatorSide::note_answer(SampleSequence sample) {
    if (sample > answered_) {
        answered_ = sample;
        statistics_.round_trip = static_cast<double>(sample_ - sample) * seconds_;
    }
}

void OperatorSide::take(const ObjectEstimates& estimates, std::uint64_t packet) {
    for (std::size_t i = 0; i < estimates.count; ++i) {
        const SessionHandle body = body_of(estimates.estimates[i].object);
        if (!truths_.knows(body) || packet <= found_[body].packet) {
            continue;
        }
        Found& found = found_[body];
        found.packet = packet;
        found.estimate = estimates.estimates[i];
        found.estimate.doubt = turned(found.estimate.doubt, settings().frame.rotation);
        if (!std::exchange(found.is_new, true)) {
            news_.push_back(body);
        }
    }
}

void OperatorSide::take(const ForceSample& force) {
    if (force.pointer >= max_proxies || force.newest_operator_sample > sample_) {
        return;
    }

    ForceSample here = force;
    here.force = direction_to_parent(settings().frame, force.force);
    here.proxy = to_parent(settings().frame, force.proxy);
    if (!traditional_.take(here, body_of(force.object), sample_)) {
        ++statistics_.stale_states;
        return;
    }
    pointers_[here.pointer].passivity.hear(settings().passivity, settings().passive, heard(here.pointer));
    note_answer(force.newest_operator_sample);
}

void OperatorSide::take(const WrenchSample& wrench) {
    if (wrench.pointer < first_tool || wrench.pointer >= first_tool + max_tools ||
        wrench.newest_operator_sample > sample_) {
        return;
    }
    WrenchSample here = wrench;
    here.force = direction_to_parent(settings().frame, wrench.force);
    here.torque = direction_to_parent(settings().frame, wrench.torque);
    here.tool = compose(settings().frame, wrench.tool);
    if (!traditional_.take(here, body_of(wrench.object), sample_)) {
        ++statistics_.stale_states;
        return;
    }
    if (!settings().robot) {  // a robot lags behind the hand, and what it touches is only seen
        resimulator_.note_tool(wrench.pointer - first_tool, wrench.newest_operator_sample, here.tool);
    }
    note_answer(wrench.newest_operator_sample);
}

void OperatorSide::take(const SampleAcknowledgements& acknowledgements) {
    for (std::size_t i = 0; i < acknowledgements.count; ++i) {
        const auto [pointer, sequence] = acknowledgements.samples[i];
        if (pointer >= first_tool + max_tools || sequence > sample_) {
            continue;
        }
        SentHand& sent = pointer < first_tool ? pointers_[pointer].sent : tools_[pointer - first_tool].sent;
        sent.acknowledged = std::max(sent.acknowledged, sequence);
    }
}

// Traditional: bodies are shown where the far side last said.
void OperatorSide::follow_far_side(SessionLoop& loop) {
    for (const SessionHandle body : truths_.fresh()) {
        if (loop.body(body) && differs(truths_.of(body).motion, loop.motion(body), settings().threshold)) {
            loop.put_right(body, truths_.of(body).motion, true);
        }
    }
    truths_.settle();
}

// --- what is true now

// Whether the far side said something that the model did not know.
bool OperatorSide::is_news(SessionLoop& loop, SessionHandle body) const {
    const Truth& truth = truths_.of(body);
    const SessionLoop::Body* const known = loop.body(body);
    if (!known) {
        return false;
    }
    const bool moves = known->motion != Motion::Static;
    if (truth.sample == no_sample && (!nothing_is_touched(loop) || (moves && !knows_all_pushes(no_sample)))) {
        return false;  // from before the first sample of a hand that has been at work since
    }
    if (settings().derivation == Derivation::none || truth.sample == no_sample || !moves) {
        return poses_differ(truth.motion.pose, loop.motion(body).pose, settings().threshold);
    }
    const std::uint32_t place = truths_.place_of(body);
    if (place == TruthStore::no_place) {
        return differs(truth.motion, loop.motion(body), settings().threshold);
    }
    const BodyMotion* const then = past_.motion(place, truth.sample);
    if (!then) {
        const BodyMotion now = loop.motion(body);
        return is_beyond_history(truth.sample) && knows_all_pushes(truth.sample) &&
               differs(derive(Derivation::velocity, derivation_input(truth, now, now)), now,
                       settings().threshold);
    }
    return settings().correction == Correction::pose
               ? poses_differ(truth.motion.pose, then->pose, settings().threshold)
               : differs(truth.motion, *then, settings().threshold);
}

bool OperatorSide::is_beyond_history(SampleSequence sample) const {
    return sample != no_sample && sample_ - sample > past_.samples();
}

// A velocity of the far side leads to the present only where no hand has pressed anything since.
bool OperatorSide::knows_all_pushes(SampleSequence sample) const {
    return past_.last_push() == no_sample || past_.last_push() <= sample;
}

bool OperatorSide::nothing_is_touched(SessionLoop& loop) const {
    for (std::size_t i = 0; i < max_proxies; ++i) {
        const SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (slot.present() && !slot.proxy->touching().empty()) {
            return false;
        }
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (loop.tool(i) && !loop.tool(i)->proxy.touching().empty()) {
            return false;
        }
    }
    return true;
}

bool OperatorSide::any_news(SessionLoop& loop) const {
    return std::ranges::any_of(truths_.fresh(), [&](SessionHandle body) { return is_news(loop, body); });
}

void OperatorSide::find_targets(SessionLoop& loop, Nanoseconds now) {
    if (settings().derivation != Derivation::resimulate || !resimulator_.exists()) {
        resimulator_.stop();
        if (any_news(loop)) {
            if (!lands(loop, now)) {
                derive_targets(loop, false);
            }
        } else {
            truths_.settle();
        }
        return;
    }
    if (!resimulator_.running() && !truths_.fresh().empty()) {
        if (!any_news(loop)) {
            learn(loop);
            truths_.settle();
        } else if (resimulator_.begin(loop, truths_, past_, sample_)) {
            ++statistics_.replays;
            learn(loop);
            lands(loop, now);  // what would be felt, for those that are put right at once
            derive_targets(loop, true);
            resimulator_.place_still(targets_);
        } else if (!lands(loop, now)) {
            derive_targets(loop, false);
        }
    }
    if (resimulator_.running() && resimulator_.advance(truths_, past_, sample_, settings().replay_steps) &&
        !lands(loop, now)) {
        const std::size_t known = targets_.size();
        resimulator_.finish(loop, truths_, settings().threshold, targets_);
        if (waits_for_tool(loop)) {
            targets_.resize(known);
        }
    }
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

// Where the past is not known, a body goes on as the far side last saw it move.
void OperatorSide::derive_targets(SessionLoop& loop, bool only_without_past) {
    for (const SessionHandle body : truths_.fresh()) {
        const Truth& truth = truths_.of(body);
        const std::uint32_t place = truths_.place_of(body);
        if (!is_news(loop, body) || (only_without_past && place != TruthStore::no_place)) {
            continue;
        }
        const BodyMotion now = loop.motion(body);
        const BodyMotion* const then = past_.motion(place, truth.sample);
        const bool moves = loop.body(body)->motion != Motion::Static;
        const Derivation how = !moves || truth.sample == no_sample ? Derivation::none
                               : then                              ? settings().derivation
                                                                   : Derivation::velocity;
        Target target{body, derive(how, derivation_input(truth, then ? *then : now, now)), false, {}};
        if (settings().correction == Correction::pose) {
            target.motion.linear_velocity = now.linear_velocity;
            target.motion.angular_velocity = now.angular_velocity;
        }
        if (place != TruthStore::no_place && truth.sample != no_sample) {
            past_.carry(place, truth.sample, sample_ - 1, now, target.motion);
        }
        targets_.push_back(target);
    }
    truths_.settle();
}

// ---

// Of all that is touched, how far off what is known least well may be.
double OperatorSide::touched_doubt(SessionLoop& loop) const {
    double most = 0.0;
    const auto look = [&](const auto& state) {
        for (int k = 0; k < state.contact_count; ++k) {
            const SessionHandle body = state.bodies[static_cast<std::size_t>(k)];
            if (truths_.knows(body) && found_[body].estimate.has_doubt) {
                most = std::max(most, place_deviation(found_[body].estimate.doubt));
            }
        }
    };
    for (std::size_t i = 0; i < max_proxies; ++i) {
        if (loop.proxy(i).present()) {
            look(loop.proxy(i).state);
        }
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (loop.tool(i)) {
            look(loop.tool(i)->state);
        }
    }
    return most;
}

void OperatorSide::report(SessionLoop& loop, Nanoseconds now) {
    if (!settings().traditional) {
        past_.note_pushes(loop, truths_, sample_);
        past_.note_motions(loop, truths_, sample_);
        if (resimulator_.exists() && settings().derivation == Derivation::resimulate) {
            resimulator_.remember(loop, sample_);
        }
    }
    for (std::size_t i = 0; i < max_proxies; ++i) {
        if (loop.proxy(i).present()) {
            note_given(loop, i);
            send_sample(loop, i, now);
        } else {
            send_absence(pointers_[i].sent, now);
        }
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (const ToolSlot* const slot = loop.tool(i)) {
            tools_[i].given = {loop.given_force(*slot), slot->state.torque};
            send_tool(loop, i, *slot, now);
        } else {
            send_absence(tools_[i].sent, now);
        }
    }
    samples_.end_tick(channel_.link(), now);
    Terms terms = channel_.terms_of_settings();
    terms.bodies = static_cast<std::uint32_t>(loop.max_bodies());
    note_hands(loop, terms);
    channel_.set_own(terms);
    acknowledge();
    statistics_.sample = sample_;
    statistics_.description = described_;
    statistics_.doubt = touched_doubt(loop);
    statistics_.ghosts = ghosts_.seen(now);
    channel_.end_tick(statistics_);
}

}  // namespace tactus
