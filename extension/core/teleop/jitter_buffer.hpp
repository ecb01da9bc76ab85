// The operator's samples at the far side, played out one a tick in their order, however they came.
//
// A sample that is there when its turn comes is played as it is. One that is missing while later ones are
// there was lost: it is filled in between its neighbours. When nothing later is there either, the buffer is
// dry: the last sample is held and its successor waits, which makes the buffer deeper by one tick, as deep as
// the link's jitter needs. Where it has been deeper than that for a while, one sample is left out.
//
// With `sparse`, missing is the rule (deadband): the last sample received is carried on with its velocity
// instead, and nothing waits: the packet that was on its way for the shortest time sets the pace.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

struct JitterBufferSettings {
    std::uint32_t depth = 0;        // samples kept in hand at the start, 0 … 200
    std::uint32_t patience = 1000;  // ticks of needless depth before a sample is left out, > 0
    bool sparse = false;
    double seconds = 0.001;  // of a tick of the operator
};

enum class Playing : std::uint8_t {
    waiting,  // nothing has come yet
    exact,
    filled,   // lost, between its neighbours
    guessed,  // sparse: carried on from the last one
    held,     // dry
};

struct BufferCounts {
    std::uint64_t exact = 0, filled = 0, guessed = 0, held = 0;
    std::uint64_t late = 0;      // came after their turn
    std::uint64_t doubled = 0;   // were there already
    std::uint64_t left_out = 0;  // to become less deep
    std::uint64_t restarts = 0;  // jumps in the sequence too wide to fill
};

// Sample: a value with `sequence`, `position` and `velocity`, all else is taken from the later neighbour.
template <typename Sample>
class JitterBuffer {
public:
    static constexpr std::size_t capacity = 1024;

    explicit JitterBuffer(const JitterBufferSettings& settings = {}) : settings_(settings), ring_(capacity) {}

    void set_settings(const JitterBufferSettings& settings) { settings_ = settings; }
    const BufferCounts& counts() const { return counts_; }
    // Samples between the one played last and the newest one.
    std::uint64_t depth() const { return newest_ > played_.sequence ? newest_ - played_.sequence : 0; }

    void insert(const Sample& sample) {
        if (sample.sequence == 0) {
            return;
        }
        if (newest_ > 0 && sample.sequence > newest_ + capacity / 2) {
            restart();
        }
        if (playing_ && sample.sequence <= played_.sequence) {
            ++counts_.late;
            if (settings_.sparse && sample.sequence > anchor_.sequence) {
                anchor_ = sample;  // too late for its own turn, but better than what was guessed from
            }
            return;
        }
        Sample& slot = ring_[sample.sequence % capacity];
        if (slot.sequence == sample.sequence) {
            ++counts_.doubled;
            return;
        }
        slot = sample;
        if (!playing_ && (first_ == 0 || sample.sequence < first_)) {
            first_ = sample.sequence;
        }
        newest_ = std::max(newest_, sample.sequence);
    }

    // One tick on. The sample is valid unless the answer is `waiting`; its sequence is the newest applied.
    Playing play(Sample& out) {
        if (newest_ == 0 || (!playing_ && newest_ - first_ < settings_.depth)) {
            return Playing::waiting;
        }
        if (!playing_) {
            playing_ = true;
            played_ = ring_[first_ % capacity];
            anchor_ = played_;
            out = played_;
            ++counts_.exact;
            return Playing::exact;
        }
        shed();
        if (settings_.sparse) {
            keep_pace();
        }
        const Playing how = next();
        out = played_;
        return how;
    }

    // The sender has started anew.
    void restart() {
        std::fill(ring_.begin(), ring_.end(), Sample{});
        newest_ = first_ = 0;
        playing_ = false;
        ++counts_.restarts;
    }

private:
    const Sample* find(std::uint64_t sequence) const {
        const Sample& slot = ring_[sequence % capacity];
        return slot.sequence == sequence ? &slot : nullptr;
    }

    Playing next() {
        const std::uint64_t turn = played_.sequence + 1;
        if (const Sample* found = find(turn)) {
            played_ = *found;
            anchor_ = played_;
            ++counts_.exact;
            return Playing::exact;
        }
        if (settings_.sparse) {
            return guess(turn);
        }
        if (newest_ <= turn) {
            ++counts_.held;
            return Playing::held;
        }
        return fill(turn);
    }

    // No farther behind the newest sample than wanted. What is left out still tells where the hand is.
    void keep_pace() {
        while (played_.sequence + 1 + settings_.depth < newest_) {
            ++counts_.left_out;
            if (const Sample* found = find(++played_.sequence)) {
                anchor_ = *found;
            }
        }
    }

    Playing guess(std::uint64_t turn) {
        const double seconds = settings_.seconds * static_cast<double>(turn - anchor_.sequence);
        played_ = anchor_;
        played_.sequence = turn;
        played_.position = anchor_.position + anchor_.velocity * seconds;
        ++counts_.guessed;
        return Playing::guessed;
    }

    Playing fill(std::uint64_t turn) {
        std::uint64_t later = turn + 1;
        while (!find(later)) {
            ++later;
        }
        const Sample& neighbour = *find(later);
        const double share = 1.0 / static_cast<double>(later - played_.sequence);
        Sample between = neighbour;
        between.sequence = turn;
        between.position = played_.position + (neighbour.position - played_.position) * share;
        between.velocity = played_.velocity + (neighbour.velocity - played_.velocity) * share;
        played_ = between;
        ++counts_.filled;
        return Playing::filled;
    }

    // What has been in hand all the time for `patience` ticks beyond the wanted depth is not needed.
    void shed() {
        least_ = std::min(least_, depth());
        if (++watched_ < settings_.patience) {
            return;
        }
        if (least_ > settings_.depth + 1 && !settings_.sparse) {
            ++played_.sequence;
            ++counts_.left_out;
        }
        watched_ = 0;
        least_ = capacity;
    }

    JitterBufferSettings settings_;
    std::vector<Sample> ring_;
    BufferCounts counts_;
    Sample played_{};
    Sample anchor_{};  // the last one that was received and played
    std::uint64_t newest_ = 0;
    std::uint64_t first_ = 0;
    bool playing_ = false;
    std::uint64_t least_ = capacity;
    std::uint32_t watched_ = 0;
};

}  // namespace tactus
