// The operator's samples at the far side, played out on this side's ticks, however they came.
//
// A playhead walks along the operator's sequence. With clocks that agree it goes one sample a tick and every
// sample is played as it is; where the ticks of the two sides differ it goes so many samples a tick as the
// ratio of the periods says, and what lies between two samples is interpolated. It keeps a lag behind the
// arrivals that is as long as the network needs: a sample's transit is the tick of its arrival less its place
// in the sequence, and the lag is what all but a few of the latest stretches of 50 ms would have needed. A
// stretch that needed much more was an outage and no jitter: it is not waited for again.
//
// What is behind, after an outage or because less lag is needed, catches up by playing faster, within
// `catch_up_seconds`, and the hand moves no faster than `catch_up_speed` meanwhile (or than it moves itself).
// When nothing is there to be played the last sample is held.
//
// With `sparse`, missing is the rule (deadband): the last sample received is carried on with its velocity as
// deadband.hpp says, held after `guess_seconds`, and nothing waits: the packet that was on its way for the
// shortest time sets the pace.
//
// With `newest`, as the thesis's system does it, none of this is done: what has come last is played.
//
// What cannot be is not believed (sequence_guard.hpp).
//
// A hand that holds a tool is turned as well (TurningSample): all of this holds for its turns.
//
// Work in a call is bounded by the ring, whatever comes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "core/math/body_motion.hpp"
#include "core/math/types.hpp"
#include "core/teleop/deadband.hpp"
#include "core/teleop/playing.hpp"
#include "core/teleop/playout_lag.hpp"
#include "core/teleop/sample_ring.hpp"
#include "core/teleop/sequence_guard.hpp"

namespace tactus {

// That says how the hand is turned, and turns (unit: radians per second).
template <typename Sample>
concept TurningSample = requires(const Sample& sample) {
    sample.rotation;
    sample.spin;
};

// Sample: a value with `sequence`, `position` and `velocity`; all else is taken from a neighbour.
template <typename Sample>
class JitterBuffer {
public:
    static constexpr std::size_t capacity = SampleRing<Sample>::capacity;
    static constexpr double catch_up_seconds = 0.25;
    static constexpr double catch_up_speed = 1.0;  // (unit: meters per second)
    static constexpr double max_speed = 20.0;      // of any hand (unit: meters per second)
    static constexpr double catch_up_spin = 10.0;  // (unit: radians per second)
    static constexpr double max_spin = 100.0;      // of any hand (unit: radians per second)

    explicit JitterBuffer(const JitterBufferSettings& settings = {}) { set_settings(settings); }

    void set_settings(const JitterBufferSettings& settings) {
        settings_ = settings;
        // Periods that no two sides have are held to what the arithmetic is made for.
        ratio_ = std::clamp(settings.seconds / settings.sample_seconds, min_ratio, max_ratio);
        guard_.set(ratio_, settings.seconds);
        lag_.set({ratio_, settings.depth, settings.sparse, ticks(PlayoutLag::stretch_seconds)});
    }
    const BufferCounts& counts() const { return counts_; }
    // Whether the hand was not there, as what was played last says: it is on its way from where it was when
    // some were missing, within an outage that is filled, or (sparse) guessed.
    bool leads() const { return led_ || (settings_.sparse ? guesses() : fills_outage_); }
    // Not of a guess: so many were missing that the operator's hand may have gone any way.
    bool is_outage() const { return leads() && (slewing_ || !settings_.sparse); }
    // Samples between the one played last and the newest one.
    std::uint64_t depth() const {
        return ring_.newest() > played_.sequence ? ring_.newest() - played_.sequence : 0;
    }

    void insert(const Sample& sample) {
        if (sample.sequence == 0) {
            return;
        }
        if (!guard_.is_plausible(sample.sequence, ring_.newest(), capacity, tick_)) {
            ++counts_.implausible;
            if (guard_.is_new_beginning(sample.sequence, tick_)) {
                begin_anew(sample);
            }
            return;
        }
        if (ring_.has(sample.sequence)) {
            ++counts_.doubled;
            return;
        }
        if (playing_) {
            lag_.note(clock_ + ratio_ - place(sample.sequence));
            if (place(sample.sequence) <= head_) {
                ++counts_.late;
                if (!settings_.sparse) {
                    return;
                }
            }
        }
        if (sample.sequence > ring_.newest()) {
            guard_.note_newest(tick_);
        }
        ring_.put(sample);
    }

    // One tick on. The sample is valid unless the answer is `waiting`; its sequence is the newest applied.
    Playing play(Sample& out) {
        ++tick_;
        if (ring_.empty()) {
            return Playing::waiting;
        }
        const bool first = !playing_ && !continues_;
        if (!playing_) {
            if (first && ring_.newest() - ring_.oldest() < settings_.depth) {
                return Playing::waiting;
            }
            begin();
        } else {
            clock_ += ratio_;
            lag_.tick();
            const double before = std::exchange(head_, next_head());
            stands_ = head_ <= before + tiny;
        }
        const Playing how = settings_.sparse ? carry_on() : stands_ ? hold() : move_to_head();
        limit_speed(first);
        out = out_;
        return how;
    }

    // The sender has started anew, or nobody is there: what comes next is a new beginning.
    void restart() {
        forget();
        continues_ = false;
        ++counts_.restarts;
    }

private:
    static constexpr double min_ratio = 1.0 / 64.0, max_ratio = 64.0;
    static constexpr double tiny = 1e-9;       // rounding (unit: samples)
    static constexpr double slow_down = 0.1;   // share of a tick that is waited to get deeper
    static constexpr double hurry = 0.1;       // share of a tick that is played more, at least, to catch up
    static constexpr std::uint64_t wide = 16;  // so many lost in a row are an outage
    static constexpr double at_once_seconds = 0.02;  // so far behind is caught up at once
    static constexpr double patience_seconds = 0.2;  // less only after so long
    static constexpr double still_after = 0.02;  // held for longer: the hand does not move (unit: seconds)

    std::uint64_t ticks(double seconds) const {
        return std::max<std::uint64_t>(1,
                                       static_cast<std::uint64_t>(std::llround(seconds / settings_.seconds)));
    }
    // Samples from the base on; wraps where the sequence is lower.
    double place(std::uint64_t sequence) const {
        return static_cast<double>(static_cast<std::int64_t>(sequence - base_));
    }
    std::uint64_t sequence_at(double head) const {
        return base_ + static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(head + tiny)));
    }

    // A hand that stands is where it was, however long ago that was said.
    bool guesses() const {
        double spin = 0.0;
        if constexpr (TurningSample<Sample>) {
            spin = glm::length(anchor_.spin);
        }
        return guessed_for_ > 1.5 * settings_.seconds && !stands(glm::length(anchor_.velocity), spin);
    }

    // A hand that is not there is at no position.
    static bool is_there(const Sample& sample) {
        if constexpr (requires { sample.connected; }) {
            return sample.connected;
        }
        return true;
    }

    void forget() {
        ring_.clear();
        playing_ = false;
        guard_.forget();
    }

    void begin_anew(const Sample& sample) {
        forget();
        continues_ = true;
        guard_.note_newest(tick_);
        ring_.put(sample);
        ++counts_.restarts;
    }

    void begin() {
        playing_ = true;
        const std::uint64_t depth = continues_ ? 0 : settings_.depth;
        base_ = ring_.at_or_after(ring_.newest() - depth)->sequence;
        head_ = 0.0;
        clock_ = place(ring_.newest());
        lag_.begin(clock_);
        behind_for_ = held_for_ = 0;
        catching_up_ = fraction_ = 0.0;
        stands_ = false;
        slewing_ = continues_;
        played_ = anchor_ = *ring_.find(base_);
    }

    double next_head() {
        if (settings_.newest && !settings_.sparse) {
            return std::max(head_, place(ring_.newest()));
        }
        const double target = clock_ - lag_.wanted();
        const double available = place(ring_.newest());
        const double reach = settings_.sparse ? target : std::min(target, available);
        const double plain = head_ + ratio_;
        const double slow = head_ + ratio_ * (1.0 - slow_down);
        if (plain > reach + tiny) {
            behind_for_ = 0;
            catching_up_ = 0.0;
            const double wanted = std::max(target, slow);
            return settings_.sparse ? wanted : std::clamp(wanted, head_, std::max(head_, available));
        }
        const double head = catch_up(plain, reach);
        return catching_up_ > 0.0 || settings_.sparse ? head : towards_a_whole_sample(head, slow);
    }

    // Between two samples the hand is where the operator's never was in a tick, and what it does there
    // answers neither of them. Where sides tick alike, a head that has come to stand between two falls back
    // to the earlier one, as slowly as it gets deeper.
    double towards_a_whole_sample(double head, double slow) const {
        if (ratio_ != 1.0) {
            return head;
        }
        return std::max(std::floor(head + tiny), std::min(slow, head));
    }

    double catch_up(double plain, double reach) {
        const double behind = reach - plain;
        const bool much = behind * settings_.sample_seconds > at_once_seconds;
        behind_for_ = behind >= 1.0 - tiny ? behind_for_ + 1 : 0;
        if (catching_up_ == 0.0 && (much || behind_for_ >= ticks(patience_seconds))) {
            ++counts_.catch_ups;
            slewing_ = true;
            catching_up_ = tiny;
        }
        if (catching_up_ > 0.0) {
            catching_up_ = std::max(
                {catching_up_, hurry * ratio_, behind / static_cast<double>(ticks(catch_up_seconds))});
            plain = std::min(plain + catching_up_, reach);
            if (plain > reach - tiny) {
                catching_up_ = 0.0;
                return reach;
            }
        }
        return plain;
    }

    Playing hold() {
        ++counts_.held;
        if (++held_for_ >= ticks(still_after)) {
            stop();
        }
        return Playing::held;
    }

    // A sample, or what lies between its neighbours.
    Playing move_to_head() {
        held_for_ = 0;
        fills_outage_ = false;
        const std::uint64_t turn = sequence_at(head_);
        const double part = std::max(0.0, head_ - place(turn));
        const Sample* const here = ring_.find(turn);
        if (here && part < tiny) {
            played_ = *here;
            fraction_ = 0.0;
            ++counts_.exact;
            return Playing::exact;
        }
        const Sample earlier = here ? *here : played_;
        const double from = here ? place(turn) : place(played_.sequence) + fraction_;
        const Sample& later = *ring_.at_or_after(turn + 1);  // the newest one is there
        fraction_ = part;
        ++counts_.filled;
        if (!is_there(earlier) || !is_there(later)) {
            played_ = earlier;
            played_.sequence = turn;
            return Playing::filled;
        }
        const double share = std::clamp((head_ - from) / (place(later.sequence) - from), 0.0, 1.0);
        fills_outage_ = later.sequence - earlier.sequence > wide;
        slewing_ = slewing_ || fills_outage_;
        played_ = later;
        played_.sequence = turn;
        played_.position = earlier.position + (later.position - earlier.position) * share;
        played_.velocity = earlier.velocity + (later.velocity - earlier.velocity) * share;
        if constexpr (TurningSample<Sample>) {
            played_.rotation = glm::slerp(earlier.rotation, later.rotation, share);
            played_.spin = earlier.spin + (later.spin - earlier.spin) * share;
        }
        return Playing::filled;
    }

    // Sparse: from the newest sample whose turn has come.
    Playing carry_on() {
        const std::uint64_t turn = sequence_at(head_);
        if (const Sample* const latest = ring_.at_or_before(turn);
            latest && latest->sequence > anchor_.sequence) {
            anchor_ = *latest;
        }
        const double carried = std::max(0.0, (head_ - place(anchor_.sequence)) * settings_.sample_seconds);
        const bool exact = anchor_.sequence == turn && carried < tiny;
        guessed_for_ = carried;
        played_ = anchor_;
        played_.sequence = turn;
        played_.position = guessed_position(anchor_.position, anchor_.velocity, carried);
        played_.velocity *= guessed_share(carried);
        if constexpr (TurningSample<Sample>) {
            played_.rotation = turn_by(anchor_.spin, guessed_time(carried)) * anchor_.rotation;
            played_.spin *= guessed_share(carried);
        }
        if (carried > settings_.guess_seconds) {
            stop();
            ++counts_.held;
            return Playing::held;
        }
        ++(exact ? counts_.exact : counts_.guessed);
        return exact ? Playing::exact : Playing::guessed;
    }

    // What is not heard of any more does not move.
    void stop() {
        played_.velocity = Vec3(0.0);
        if constexpr (TurningSample<Sample>) {
            played_.spin = Vec3(0.0);
        }
        slewing_ = true;
    }

    // Where the hand went on while nothing was heard it is led there. One that comes begins where it is.
    // `first`: there is no hand yet.
    void limit_speed(bool first) {
        const Sample before = std::exchange(out_, played_);
        led_ = false;
        if (first) {
            return;
        }
        if (is_there(before) && is_there(played_)) {
            led_ = limit_way(before.position);
            if constexpr (TurningSample<Sample>) {
                led_ = limit_turn(before.rotation) || led_;
            }
        }
        const bool is_held = held_for_ > 0 || (settings_.sparse && guessed_for_ > settings_.guess_seconds);
        if (!led_ && catching_up_ == 0.0 && !is_held) {
            slewing_ = false;
        }
    }

    // True where it is farther away than the hand may go in a tick.
    bool limit_way(const Vec3& from) {
        constexpr double over_own = 1.25;
        const double own = std::clamp(over_own * glm::length(played_.velocity), catch_up_speed, max_speed);
        const double speed = slewing_ ? own : max_speed;
        const Vec3 way = played_.position - from;
        const double distance = glm::length(way);
        if (distance > speed * settings_.seconds) {
            out_.position = from + way * (speed * settings_.seconds / distance);
            return true;
        }
        return false;
    }

    bool limit_turn(const Quat& from)
        requires TurningSample<Sample>
    {
        constexpr double over_own = 1.25;
        const double own = std::clamp(over_own * glm::length(played_.spin), catch_up_spin, max_spin);
        const double most = (slewing_ ? own : max_spin) * settings_.seconds;
        const double angle = angle_between(from, played_.rotation);
        if (angle > most) {
            out_.rotation = glm::slerp(from, played_.rotation, most / angle);
            return true;
        }
        return false;
    }

    JitterBufferSettings settings_;
    double ratio_ = 1.0;  // samples of the operator in a tick here
    SampleRing<Sample> ring_;
    SequenceGuard guard_;
    PlayoutLag lag_;
    BufferCounts counts_;

    bool playing_ = false;
    bool continues_ = false;  // a hand has been played before: what begins is led on from there
    std::uint64_t tick_ = 1;
    std::uint64_t base_ = 0;     // the sequence that places count from
    double clock_ = 0.0;         // place of a sample that would come now after no time (unit: samples)
    double head_ = 0.0;          // place that is played
    bool stands_ = false;        // the head has not moved in this tick
    Sample played_{};            // at the head
    double fraction_ = 0.0;      // of the head beyond played_.sequence
    Sample anchor_{};            // sparse: the last one that was received and whose turn has come
    double guessed_for_ = 0.0;   // sparse: in the last tick (unit: seconds)
    bool led_ = false;           // by limit_speed(), in the last tick
    bool fills_outage_ = false;  // between two samples that are far apart, in the last tick
    Sample out_{};               // played_, led there no faster than a hand moves

    std::uint64_t behind_for_ = 0, held_for_ = 0;  // (unit: ticks)
    double catching_up_ = 0.0;                     // samples more in a tick; 0: it does not
    bool slewing_ = false;
};

}  // namespace tactus
