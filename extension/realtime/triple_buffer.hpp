// The newest value wins: one thread publishes, one thread looks, neither ever waits and neither sees a
// half-written value.
//
// Of three slots one belongs to the writer, one to the reader, and the middle one changes hands by a single
// atomic exchange. Threads: back() and publish() belong to the writer, refresh() and front() to the reader.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "realtime/spsc_ring.hpp"

namespace tactus {

template <typename T>
class TripleBuffer {
public:
    // Every slot starts as a copy of `initial`: containers inside it should come with their final capacity.
    explicit TripleBuffer(const T& initial = T{}) : slots_{Slot{initial}, Slot{initial}, Slot{initial}} {}

    TripleBuffer(const TripleBuffer&) = delete;
    TripleBuffer& operator=(const TripleBuffer&) = delete;

    // The slot to fill. After publish() it is another one, holding some older value: write it whole.
    T& back() { return slots_[back_].value; }

    void publish() {
        const std::uint32_t handed_over = middle_.exchange(back_ | fresh, std::memory_order_acq_rel);
        back_ = handed_over & index_mask;
    }

    void publish(const T& value) {
        back() = value;
        publish();
    }

    // Whether refresh() would take a value.
    bool is_fresh() const { return (middle_.load(std::memory_order_acquire) & fresh) != 0; }

    // Takes the newest published value, if there is one that has not been taken. True: front() has changed.
    bool refresh() {
        if ((middle_.load(std::memory_order_relaxed) & fresh) == 0) {
            return false;
        }
        const std::uint32_t taken = middle_.exchange(front_, std::memory_order_acq_rel);
        front_ = taken & index_mask;
        return true;
    }

    // The value that refresh() took last; before the first one, the initial value.
    const T& front() const { return slots_[front_].value; }

private:
    struct alignas(cache_line_bytes) Slot {
        T value;
    };

    static constexpr std::uint32_t index_mask = 3;
    static constexpr std::uint32_t fresh = 4;  // set by the writer: the reader has not taken this slot yet

    std::array<Slot, 3> slots_;
    alignas(cache_line_bytes) std::uint32_t back_ = 0;
    alignas(cache_line_bytes) std::atomic<std::uint32_t> middle_{1};
    alignas(cache_line_bytes) std::uint32_t front_ = 2;
};

}  // namespace tactus
