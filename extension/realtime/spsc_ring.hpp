// A queue between exactly two threads: one pushes, one pops, neither ever waits.
//
// Threads: try_push() belongs to the producer, try_pop() and front()/pop() to the consumer; size() may be
// called by either and is exact only for the caller's own end. Construction and destruction belong to whoever
// owns both ends. A popped value that owns memory frees it in the thread that destroys it: hand such values
// back through a second ring where the consumer is the haptic thread.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace tactus {

// Two cores writing within the same line of this size slow each other down (unit: bytes). Twice the line of
// x86-64, whose prefetcher fetches lines in pairs.
inline constexpr std::size_t cache_line_bytes = 128;

template <typename T>
class SpscRing {
    static_assert(std::is_nothrow_move_constructible_v<T> && std::is_nothrow_move_assignable_v<T>);

public:
    // Holds at least `capacity` values: rounded up to a power of two. All memory is allocated and touched
    // here.
    explicit SpscRing(std::size_t capacity)
        : mask_(std::bit_ceil(capacity < 1 ? std::size_t{1} : capacity) - 1),
          slots_(std::make_unique<Slot[]>(mask_ + 1)) {}

    ~SpscRing() {
        while (front() != nullptr) {
            pop();
        }
    }

    SpscRing(const SpscRing&) = delete;
    SpscRing& operator=(const SpscRing&) = delete;

    std::size_t capacity() const { return mask_ + 1; }

    std::size_t size() const {
        return tail_.load(std::memory_order_acquire) - head_.load(std::memory_order_acquire);
    }

    // False when full: the value is left where it was, not moved from.
    bool try_push(T&& value) {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        if (!has_room(tail)) {
            return false;
        }
        ::new (static_cast<void*>(slots_[tail & mask_].bytes)) T(std::move(value));
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    bool try_push(const T& value)
        requires std::is_nothrow_copy_constructible_v<T>
    {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        if (!has_room(tail)) {
            return false;
        }
        ::new (static_cast<void*>(slots_[tail & mask_].bytes)) T(value);
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    // The oldest value, to be read in place; null when there is none. Stays valid until pop().
    T* front() {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head == tail_seen_) {
            tail_seen_ = tail_.load(std::memory_order_acquire);
            if (head == tail_seen_) {
                return nullptr;
            }
        }
        return value_at(head);
    }

    // Destroys the oldest value. Only after front() has returned it.
    void pop() {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        value_at(head)->~T();
        head_.store(head + 1, std::memory_order_release);
    }

    bool try_pop(T& value) {
        T* oldest = front();
        if (oldest == nullptr) {
            return false;
        }
        value = std::move(*oldest);
        pop();
        return true;
    }

private:
    struct Slot {
        alignas(T) std::byte bytes[sizeof(T)];
    };

    // Indices count up for ever and wrap as unsigned numbers do; the difference is the number of values
    // inside.
    bool has_room(std::size_t tail) {
        if (tail - head_seen_ <= mask_) {
            return true;
        }
        head_seen_ = head_.load(std::memory_order_acquire);
        return tail - head_seen_ <= mask_;
    }

    T* value_at(std::size_t index) { return std::launder(reinterpret_cast<T*>(slots_[index & mask_].bytes)); }

    const std::size_t mask_;
    const std::unique_ptr<Slot[]> slots_;
    alignas(cache_line_bytes) std::atomic<std::size_t> tail_{0};  // written by the producer
    std::size_t head_seen_ = 0;                                   // the producer's last look at head_
    alignas(cache_line_bytes) std::atomic<std::size_t> head_{0};  // written by the consumer
    std::size_t tail_seen_ = 0;                                   // the consumer's last look at tail_
};

}  // namespace tactus
