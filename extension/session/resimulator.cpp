#include "session/resimulator.hpp"

#include <algorithm>

namespace tactus {

Resimulator::Resimulator(const SessionSettings& session, std::size_t samples, std::size_t samples_a_memento,
                         std::size_t memento_bytes, bool exists)
    : samples_a_memento_(std::max<std::size_t>(1, samples_a_memento)) {
    if (!exists) {
        return;
    }
    twin_ = std::make_unique<SessionLoop>(session, nobody_looks_);
    const std::size_t count = std::max<std::size_t>(1, samples / samples_a_memento_);
    mementos_.assign(count, LoopMemento(session.max_bodies, memento_bytes));
    memento_of_.assign(count, no_sample);
    plan_.reserve(session.max_bodies);
    put_in_.assign(session.max_bodies, no_sample);
}

void Resimulator::remember(SessionLoop& loop, SampleSequence sample) {
    if (sample % samples_a_memento_ == 0) {
        const std::size_t index = sample / samples_a_memento_ % mementos_.size();
        memento_of_[index] = loop.save(mementos_[index]) ? sample : no_sample;
    }
}

void Resimulator::plan(const TruthStore& truths) {
    plan_.clear();
    next_ = 0;
    for (std::size_t place = 0; place < truths.places(); ++place) {
        const SessionHandle body = truths.body_at(place);
        if (body != no_handle && truths.of(body).sample != no_sample) {
            plan_.push_back({truths.of(body).sample, body, truths.of(body).motion});
        }
    }
    std::ranges::sort(plan_, [](const Planned& a, const Planned& b) {
        return a.sample != b.sample ? a.sample < b.sample : a.body < b.body;
    });
}

bool Resimulator::begin(SessionLoop& loop, const TruthStore& truths, const ModelPast& past,
                        SampleSequence now) {
    SampleSequence oldest = no_sample;
    for (const SessionHandle body : truths.fresh()) {
        const SampleSequence sample = truths.of(body).sample;
        if (sample != no_sample && truths.place_of(body) != TruthStore::no_place &&
            now - sample < past.samples()) {
            oldest = oldest == no_sample ? sample : std::min(oldest, sample);
        }
    }
    std::size_t start = mementos_.size();
    for (std::size_t i = 0; i < mementos_.size() && oldest != no_sample; ++i) {
        const bool fits =
            memento_of_[i] != no_sample && memento_of_[i] <= oldest && now - memento_of_[i] < past.samples();
        if (fits && (start == mementos_.size() || memento_of_[i] > memento_of_[start])) {
            start = i;
        }
    }
    if (start == mementos_.size() || !twin_->restore(mementos_[start])) {
        return false;
    }
    twin_->follow_still(loop);
    running_ = true;
    replayed_ = memento_of_[start];
    first_truth_ = oldest;
    plan(truths);
    while (next_ < plan_.size() && plan_[next_].sample < replayed_) {
        ++next_;  // the memento knows it
    }
    return true;
}

void Resimulator::place_still(std::span<const Target> targets) {
    for (const Target& target : targets) {
        const SessionLoop::Body* const body = twin_->body(target.body);
        if (body && body->motion == Motion::Static) {
            twin_->put_right(target.body, target.motion, false, false, &target.motion.pose);
        }
    }
}

// The twin stands after the step of `replayed_`, and begins the next tick: what was true then.
void Resimulator::put_in() {
    for (; next_ < plan_.size() && plan_[next_].sample == replayed_; ++next_) {
        twin_->put_right(plan_[next_].body, plan_[next_].motion, true);
        put_in_[plan_[next_].body] = replayed_;
    }
    put_in_tools();
}

void Resimulator::put_in_tools() {
    std::array<ToolMemory, max_tools> known;
    SessionLoop::ToolPlaces places{};
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (tools_[i].sample == replayed_) {
            known[i].pose = tools_[i].pose;
            known[i].present = true;
            places[i] = &known[i];
        }
    }
    twin_->put_tools(places);
}

void Resimulator::tick(const TruthStore& truths, ModelPast& past) {
    twin_->begin_replay_tick();
    put_in();
    const ModelPast::Moment& moment = past.moment(++replayed_);
    for (std::size_t i = 0; i < max_proxies; ++i) {
        SessionLoop::ProxySlot& slot = twin_->proxy(i);
        slot.hand = moment.hands[i].position;
        slot.hand_velocity = moment.hands[i].velocity;
        slot.idle = moment.hands[i].idle;
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (ToolSlot* const slot = twin_->tool(i)) {
            slot->hand = moment.tools[i];
        }
    }
    twin_->end_replay_tick(moment.time);
    if (replayed_ <= first_truth_) {
        return;
    }
    // What comes in later is compared with this past, and starts from it.
    past.note_pushes(*twin_, truths, replayed_);
    past.note_motions(*twin_, truths, replayed_);
    remember(*twin_, replayed_);
}

bool Resimulator::advance(const TruthStore& truths, ModelPast& past, SampleSequence now,
                          std::uint32_t ticks) {
    // What a tool does takes as long in the past as in the present.
    constexpr std::int64_t max_tool_work = 12'000;  // see ToolSettings
    constexpr std::uint32_t least = 2;              // else the present would run away
    std::int64_t work = 0;
    for (std::uint32_t i = 0; i < ticks && replayed_ + 1 < now && (i < least || work < max_tool_work); ++i) {
        tick(truths, past);
        work += twin_->take_tool_work();
    }
    return replayed_ + 1 == now;
}

void Resimulator::finish(SessionLoop& loop, const TruthStore& truths, const MotionThreshold& threshold,
                         std::vector<Target>& targets) {
    running_ = false;
    twin_->begin_replay_tick();
    put_in();
    for (std::size_t place = 0; place < truths.places(); ++place) {
        const SessionHandle handle = truths.body_at(place);
        const SessionLoop::Body* const body = twin_->body(handle);
        if (!body || !loop.body(handle)) {
            continue;
        }
        const BodyMotion replayed = twin_->motion(handle);
        if (differs(replayed, loop.motion(handle), threshold)) {
            targets.push_back({handle, replayed, true, twin_->scene().body(body->slot).previous});
        }
    }
}

void Resimulator::forget() {
    std::ranges::fill(memento_of_, no_sample);
    std::ranges::fill(put_in_, no_sample);
    tools_ = {};
    running_ = false;
}

}  // namespace tactus
