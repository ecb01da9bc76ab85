// The time of a scripted hand on its path: it begins with the first tick that reads the hand, and anew with
// the first one after restart().
#pragma once

#include <atomic>

#include "core/math/types.hpp"

namespace tactus {

class PathClock {
public:
    // The loop, once a tick: how long the hand has been on its way.
    Nanoseconds at(Nanoseconds now) {
        if (is_to_begin_.exchange(false, std::memory_order_acq_rel)) {
            start_ = now;
        }
        elapsed_.store(now - start_, std::memory_order_release);
        return now - start_;
    }

    // Any thread, any time.
    void restart() { is_to_begin_.store(true, std::memory_order_release); }
    // In the last tick; 0 where the path is to begin with the next one.
    Nanoseconds elapsed() const {
        return is_to_begin_.load(std::memory_order_acquire) ? 0 : elapsed_.load(std::memory_order_acquire);
    }

private:
    std::atomic<bool> is_to_begin_ = true;
    std::atomic<Nanoseconds> elapsed_ = 0;
    Nanoseconds start_ = 0;  // the loop's
};

}  // namespace tactus
