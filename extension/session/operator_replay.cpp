// Re-simulation: a twin of the loop goes back to the far side's last word and does the hand's part again.
#include <algorithm>

#include "session/operator_side.hpp"

namespace tactus {

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

}  // namespace tactus
