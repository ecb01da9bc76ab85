// The newest samples of a sequence by their number: what has come and what has not.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus {

// Sample: a value with `sequence`, counting from 1. All memory is taken in the constructor.
template <typename Sample>
class SampleRing {
public:
    static constexpr std::size_t capacity = 1024;

    SampleRing() : slots_(capacity) {}

    bool empty() const { return newest_ == 0; }
    std::uint64_t newest() const { return newest_; }  // 0: none
    // The first one since clear(), or the oldest place there is.
    std::uint64_t oldest() const { return newest_ - first_ < capacity ? first_ : newest_ - (capacity - 1); }

    // `sequence` > 0; what is older than the ring is left out.
    void put(const Sample& sample) {
        const std::uint64_t sequence = sample.sequence;
        if (newest_ == 0) {
            first_ = newest_ = sequence;
        } else if (sequence > newest_) {
            make_place(sequence);
        } else if (newest_ - sequence >= capacity) {
            return;
        }
        first_ = sequence < first_ ? sequence : first_;
        slots_[sequence % capacity] = sample;
        word(sequence) |= bit(sequence);
    }

    bool has(std::uint64_t sequence) const {
        return newest_ != 0 && sequence <= newest_ && newest_ - sequence < capacity &&
               (came_[sequence % capacity / word_bits] & bit(sequence)) != 0;
    }
    const Sample* find(std::uint64_t sequence) const {
        return has(sequence) ? &slots_[sequence % capacity] : nullptr;
    }

    // Null: none.
    const Sample* at_or_after(std::uint64_t sequence) const {
        for (std::uint64_t s = sequence < oldest() ? oldest() : sequence; newest_ != 0 && s <= newest_; ++s) {
            if (has(s)) {
                return &slots_[s % capacity];
            }
        }
        return nullptr;
    }
    const Sample* at_or_before(std::uint64_t sequence) const {
        for (std::uint64_t s = sequence > newest_ ? newest_ : sequence; newest_ != 0 && s >= oldest(); --s) {
            if (has(s)) {
                return &slots_[s % capacity];
            }
        }
        return nullptr;
    }

    void clear() {
        came_ = {};
        newest_ = first_ = 0;
    }

private:
    static constexpr std::uint64_t word_bits = 64;

    void make_place(std::uint64_t newest) {
        if (newest - newest_ >= capacity) {
            came_ = {};
        } else {
            for (std::uint64_t s = newest_ + 1; s < newest; ++s) {
                word(s) &= ~bit(s);
            }
        }
        newest_ = newest;
    }
    std::uint64_t& word(std::uint64_t sequence) { return came_[sequence % capacity / word_bits]; }
    static std::uint64_t bit(std::uint64_t sequence) { return std::uint64_t{1} << (sequence % word_bits); }

    std::vector<Sample> slots_;
    std::array<std::uint64_t, capacity / word_bits> came_{};
    std::uint64_t newest_ = 0;
    std::uint64_t first_ = 0;
};

}  // namespace tactus
