// A wait that another thread ends without waiting itself.
//
// Threads: wait_until() belongs to one; wake() may be called by any, also by the haptic thread: it is at most
// one system call, which does not block, and none while no thread waits.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/math/types.hpp"

namespace tactus {

// A file or socket whose readiness ends a wait as well. Windows: sockets that are read.
struct WaitFile {
    std::int64_t handle = -1;
    bool reads = true;    // it ends the wait when it can be read,
    bool writes = false;  // or written
};

class WakeSignal {
public:
    static constexpr std::size_t max_files = 15;

    WakeSignal();
    ~WakeSignal();
    WakeSignal(const WakeSignal&) = delete;
    WakeSignal& operator=(const WakeSignal&) = delete;

    // Empty, or why it cannot wait; it then sleeps to the deadline.
    const std::string& error() const { return error_; }

    void wake();

    // Returns when `is_there` returns true, one of the files is ready or the deadline (on the steady clock)
    // has passed. What `is_there` looks at has to be changed before wake() is called.
    template <typename Condition>
    void wait_until(Nanoseconds deadline, std::span<const WaitFile> files, const Condition& is_there) {
        waits_.store(true, std::memory_order_seq_cst);
        if (!is_there()) {
            wait(deadline, files);
        }
        waits_.store(false, std::memory_order_relaxed);
    }

private:
    struct System;

    void wait(Nanoseconds deadline, std::span<const WaitFile> files);
    void signal();

    std::unique_ptr<System> system_;
    std::string error_;
    std::atomic<bool> waits_{false};
};

}  // namespace tactus
