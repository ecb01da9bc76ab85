// What a process has as a whole for as long as one of its threads wants it.
#pragma once

#include <mutex>
#include <string>

namespace tactus {

// Threads: any.
class HeldByThreads {
public:
    // Empty, or why not; then this thread does not hold it. take(is_first) says the same of the system.
    template <typename Take>
    std::string hold(Take&& take) {
        const std::lock_guard guard(guard_);
        std::string refused = take(holders_ == 0);
        holders_ += refused.empty() ? 1 : 0;
        return refused;
    }

    // Once for each hold() that was granted: the last one gives it back.
    template <typename GiveBack>
    void let_go(GiveBack&& give_back) {
        const std::lock_guard guard(guard_);
        --holders_;
        if (holders_ == 0) {
            give_back();
        }
    }

private:
    std::mutex guard_;
    int holders_ = 0;
};

}  // namespace tactus
