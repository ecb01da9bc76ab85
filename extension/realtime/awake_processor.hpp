// Has one processor awake when a haptic thread that sleeps on it is due.
//
// A processor with nothing to do is halted, and waking it takes tens of microseconds. A thread of idle
// priority, which gives way to everything else, wakes it a little before each deadline and keeps it running
// until then: the haptic thread's own timer finds it awake. It takes nothing from any other thread.
//
// Threads: start() and stop() belong to one owner. The thread inside waits for no other and shares one flag.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/math/types.hpp"
#include "platform/thread.hpp"

namespace tactus {

// When the processor has to be awake.
struct AwakeTimes {
    Nanoseconds period = 1'000'000;  // > 0
    Nanoseconds phase = 0;           // deadlines are at multiples of the period plus this, on monotonic_now()
    // Before each deadline. Twice what a halted processor takes to wake up, as measured (docs/realtime.md);
    // a period or more: always.
    Nanoseconds lead = 120'000;
};

class AwakeProcessor {
public:
    AwakeProcessor() = default;
    ~AwakeProcessor() { stop(); }
    AwakeProcessor(const AwakeProcessor&) = delete;
    AwakeProcessor& operator=(const AwakeProcessor&) = delete;

    // Empty text, or why the processor is left to itself. Refused where this process's share of processor
    // time is limited (a container's quota): there idling would be paid for with ticks.
    std::string start(int cpu, const AwakeTimes& times);
    void stop();

private:
    static void run(void* self);

    struct Running {
        int cpu = 0;
        AwakeTimes times;
        std::atomic<bool> stop_requested{false};
        Thread thread;
    };
    std::shared_ptr<Running> running_;  // null: none
};

}  // namespace tactus
