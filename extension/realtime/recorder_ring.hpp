// Fixed-size records from the haptic thread to whoever writes them down. A record that finds no room is lost
// and counted: the loop never waits for a disk.
//
// Threads: append() belongs to the haptic thread; drain() and take_lost() to the one thread that writes the
// file.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "realtime/spsc_ring.hpp"

namespace tactus {

template <typename Record>
class RecorderRing {
    static_assert(std::is_trivially_copyable_v<Record>);

public:
    // At 1000 records a second a drain every 0.1 s needs 100; leave room for a file system that pauses.
    explicit RecorderRing(std::size_t capacity) : ring_(capacity) {}

    std::size_t capacity() const { return ring_.capacity(); }

    bool append(const Record& record) {
        if (ring_.try_push(record)) {
            return true;
        }
        lost_.fetch_add(1, std::memory_order_relaxed);
        return false;
    }

    // Calls take(const Record&) for what is there, oldest first, and at most capacity() times, so that a fast
    // producer cannot keep the caller here. Returns how many were taken.
    template <typename Take>
    std::size_t drain(Take&& take) {
        std::size_t taken = 0;
        for (; taken < ring_.capacity(); ++taken) {
            const Record* record = ring_.front();
            if (record == nullptr) {
                break;
            }
            take(*record);
            ring_.pop();
        }
        return taken;
    }

    // How many records were lost since the last call.
    std::uint64_t take_lost() { return lost_.exchange(0, std::memory_order_relaxed); }

private:
    SpscRing<Record> ring_;
    alignas(cache_line_bytes) std::atomic<std::uint64_t> lost_{0};
};

}  // namespace tactus
