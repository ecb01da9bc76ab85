// A queue of bytes between two threads, in which what belongs together arrives together or not at all. All
// memory is taken in the constructor; neither side ever waits.
//
// Threads: append(), commit() and abandon() belong to the producer, read() to the consumer.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

#include "realtime/spsc_ring.hpp"

namespace tactus {

class ByteRing {
public:
    // Rounded up to a power of two. All memory is allocated and touched here.
    explicit ByteRing(std::size_t capacity)
        : mask_(std::bit_ceil(std::max<std::size_t>(capacity, 1)) - 1),
          bytes_(std::make_unique<std::byte[]>(mask_ + 1)) {}

    std::size_t capacity() const { return mask_ + 1; }

    // False where there is no room; then nothing of what has not been committed can be, see abandon().
    bool append(const void* from, std::size_t size) {
        const std::size_t used = begun_ - head_.load(std::memory_order_acquire);
        if (size > capacity() - used) {
            return false;
        }
        const std::size_t at = begun_ & mask_;
        const std::size_t until_end = std::min(size, capacity() - at);
        std::memcpy(bytes_.get() + at, from, until_end);
        std::memcpy(bytes_.get(), static_cast<const std::byte*>(from) + until_end, size - until_end);
        begun_ += size;
        return true;
    }

    // What has been appended since the last one may be read.
    void commit() { tail_.store(begun_, std::memory_order_release); }
    // It is forgotten.
    void abandon() { begun_ = tail_.load(std::memory_order_relaxed); }

    // Moves all that is there to the end of `into`.
    void read(std::vector<std::byte>& into) {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        const std::size_t size = tail_.load(std::memory_order_acquire) - head;
        const std::size_t at = head & mask_;
        const std::size_t until_end = std::min(size, capacity() - at);
        into.insert(into.end(), bytes_.get() + at, bytes_.get() + at + until_end);
        into.insert(into.end(), bytes_.get(), bytes_.get() + (size - until_end));
        head_.store(head + size, std::memory_order_release);
    }

private:
    const std::size_t mask_;
    const std::unique_ptr<std::byte[]> bytes_;
    // Counts of bytes, which wrap as unsigned numbers do.
    alignas(cache_line_bytes) std::atomic<std::size_t> tail_{0};  // written by the producer
    std::size_t begun_ = 0;                                       // the producer's, from tail_ on
    alignas(cache_line_bytes) std::atomic<std::size_t> head_{0};  // written by the consumer
};

}  // namespace tactus
