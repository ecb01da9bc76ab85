// Which of a sender's numbered packets have come: tells the first arrival from a copy, and counts what is
// missing.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace tactus {

class SequenceWindow {
public:
    // How far back an arrival can still be told from a copy: a second at a thousand packets a second.
    static constexpr std::uint64_t length = 1024;

    enum class Arrival : std::uint8_t {
        newest,   // later than all before
        late,     // overtaken, but here for the first time
        copy,     // has come before
        too_old,  // so far back that nobody can tell
    };

    // `sequence` counts up from 1. The first one seen begins the count: a late joiner has lost nothing.
    Arrival note(std::uint64_t sequence) {
        if (newest_ == 0) {
            first_ = newest_ = sequence;
            ++seen_;
            set(sequence);
            return Arrival::newest;
        }
        if (sequence > newest_) {
            advance(sequence);
            return Arrival::newest;
        }
        if (newest_ - sequence >= length) {
            return Arrival::too_old;
        }
        if (is_set(sequence)) {
            return Arrival::copy;
        }
        set(sequence);
        seen_ += sequence >= first_ ? 1 : 0;
        return Arrival::late;
    }

    // Whether note() would answer `copy` or `too_old`.
    bool has_come(std::uint64_t sequence) const {
        return newest_ != 0 && sequence <= newest_ && (newest_ - sequence >= length || is_set(sequence));
    }

    std::uint64_t newest() const { return newest_; }

    // Sent since the first one seen and not here: lost, or still on the way.
    std::uint64_t missing() const { return newest_ == 0 ? 0 : newest_ - first_ + 1 - seen_; }

    // What has come up to a sequence after which `settled_after` others have come: what was overtaken is
    // counted there, as long as no more overtake.
    struct Settled {
        std::uint64_t sequence = 0;  // 0: none yet
        std::uint64_t packets = 0;   // from the first one seen up to it, without copies
    };
    static constexpr std::uint64_t settled_after = 128;
    Settled settled() const {
        if (newest_ < first_ + settled_after) {
            return {};
        }
        std::uint64_t later = 0;
        for (std::uint64_t sequence = newest_ - settled_after + 1; sequence <= newest_; ++sequence) {
            later += is_set(sequence) ? 1 : 0;
        }
        return {newest_ - settled_after, seen_ - later};
    }

    void forget() { *this = {}; }

private:
    static constexpr std::uint64_t word_bits = 64;

    void advance(std::uint64_t to) {
        if (to - newest_ >= length) {
            came_ = {};
        } else {
            for (std::uint64_t sequence = newest_ + 1; sequence < to; ++sequence) {
                clear(sequence);
            }
        }
        newest_ = to;
        ++seen_;
        set(to);
    }

    static std::size_t index(std::uint64_t sequence) { return sequence % length / word_bits; }
    std::uint64_t& word(std::uint64_t sequence) { return came_[index(sequence)]; }
    static std::uint64_t bit(std::uint64_t sequence) { return std::uint64_t{1} << (sequence % word_bits); }
    bool is_set(std::uint64_t sequence) const { return (came_[index(sequence)] & bit(sequence)) != 0; }
    void set(std::uint64_t sequence) { word(sequence) |= bit(sequence); }
    void clear(std::uint64_t sequence) { word(sequence) &= ~bit(sequence); }

    std::array<std::uint64_t, length / word_bits> came_{};
    std::uint64_t first_ = 0;
    std::uint64_t newest_ = 0;  // 0: none yet
    std::uint64_t seen_ = 0;    // from first_ on, without copies
};

}  // namespace tactus
