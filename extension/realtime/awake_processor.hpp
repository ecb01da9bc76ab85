// Keeps one processor from falling asleep, so that a sleeping haptic thread on it is woken in time.
//
// A processor with nothing to do is halted. Waking it takes tens of microseconds on bare metal; in a virtual
// machine it has to queue for a real processor first, for milliseconds. A thread of idle priority, which
// gives way to everything else, keeps it running: it takes nothing from any other thread, but electricity.
//
// Threads: start() and stop() belong to one owner. The thread inside waits for nobody and shares one flag.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "platform/thread.hpp"

namespace tactus {

class AwakeProcessor {
public:
    AwakeProcessor() = default;
    ~AwakeProcessor() { stop(); }
    AwakeProcessor(const AwakeProcessor&) = delete;
    AwakeProcessor& operator=(const AwakeProcessor&) = delete;

    // Empty text, or why the processor is left to itself. Refused where this process's share of processor
    // time is limited (a container's quota): there idling would be paid for with ticks.
    std::string start(int cpu);
    void stop();

private:
    static void run(void* self);

    struct Running {
        int cpu = 0;
        std::atomic<bool> stop_requested{false};
        Thread thread;
    };
    std::shared_ptr<Running> running_;  // null: none
};

}  // namespace tactus
