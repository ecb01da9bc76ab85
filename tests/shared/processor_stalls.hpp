// Spans in which a processor ran no thread, however urgent: a hypervisor had given it to another machine, or
// a kernel that cannot be interrupted was at work. A thread on each processor, before those of loops and
// devices, wakes five times a millisecond and notes how late it was.
//
// Threads: any_since() may be called by any.
#pragma once

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "core/math/types.hpp"

namespace tactus::shared {

class ProcessorStalls {
public:
    ProcessorStalls();
    ~ProcessorStalls();
    ProcessorStalls(const ProcessorStalls&) = delete;
    ProcessorStalls& operator=(const ProcessorStalls&) = delete;

    // Whether a processor has stood still since `time` (on the steady clock), or does so now. Finds each
    // stall of 0.3 ms, and some as short as 0.1 ms.
    bool any_since(Nanoseconds time) const;

private:
    struct Witness {
        std::atomic<Nanoseconds> due{0}, late_at{0};
        std::thread thread;
    };
    void run(Witness& witness, int processor) const;

    std::atomic<bool> end_{false};
    std::vector<std::unique_ptr<Witness>> witnesses_;
};

}  // namespace tactus::shared
