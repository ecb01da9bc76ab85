// The haptic thread: wakes on an absolute schedule, calls one function a tick, counts, and sleeps again.
//
// Threads: start(), stop() and the destructor belong to one owner. The tick function runs on the loop's own
// thread, in the haptic role. take_status(), statistics() and the counters may be called by anybody at any
// time. The thread itself neither allocates nor locks once start() has returned; its only blocking call is
// its own sleep.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "core/math/types.hpp"
#include "platform/realtime_thread.hpp"
#include "platform/thread.hpp"
#include "realtime/awake_processor.hpp"
#include "realtime/sleeper.hpp"
#include "realtime/tick_statistics.hpp"
#include "realtime/tick_status.hpp"
#include "realtime/tick_trace.hpp"

namespace tactus {

// `scheduled` (a point on monotonic_now()'s clock) rises by exactly one period from tick to tick, however
// late the tick runs; only after a rebase by more.
using TickFunction = TickStatus (*)(void* context, Nanoseconds scheduled);

struct TickLoopSettings {
    Nanoseconds period = 1'000'000;  // > 0

    // Deadlines lie on multiples of the period plus this. A quarter keeps off the instants at which the
    // kernel does its own regular work, which lie on whole milliseconds, and from a second loop at three
    // quarters.
    Nanoseconds phase = 250'000;

    // A tick later than this moves the schedule instead of being caught up. Longer than any stall of a
    // working machine: a crowded virtual machine was seen to stand still for a third of a second.
    Nanoseconds rebase_after = 1'000'000'000;

    RealtimeRequest realtime;
    SleepSettings sleep;
    Nanoseconds awake_lead = AwakeTimes{}.lead;  // where the processor is kept awake, see there
    const char* thread_name = "tactus-haptic";   // at most 15 characters; outlives the loop
};

class TickLoop {
public:
    TickLoop() = default;
    ~TickLoop() { stop(); }
    TickLoop(const TickLoop&) = delete;
    TickLoop& operator=(const TickLoop&) = delete;

    // Returns when the thread is set up and about to tick: an empty text, or why it could not start.
    // `context` and `trace` (null: no trace) must outlive stop(). Statistics start anew.
    std::string start(const TickLoopSettings& settings, TickFunction tick, void* context,
                      TickTrace* trace = nullptr);

    // Returns when the last tick has ended: within one period and one tick. Without effect when not running.
    void stop();

    bool running() const { return running_; }

    // What the system granted; valid once start() has succeeded.
    const RealtimeReport& realtime_report() const { return report_; }

    // The OR of all ticks' statuses since the last call.
    TickStatus take_status() { return status_.exchange(0, std::memory_order_acq_rel); }

    std::uint64_t ticks() const { return ticks_.load(std::memory_order_acquire); }

    // Time given up by rebasing, all in all (unit: nanoseconds).
    Nanoseconds time_lost() const { return time_lost_.load(std::memory_order_relaxed); }

    const TickStatistics& statistics() const { return *statistics_; }
    TickStatistics& statistics() { return *statistics_; }

private:
    void keep_awake();
    void run();
    void run_tick(Nanoseconds scheduled, Nanoseconds start, Nanoseconds due_next, TickStatus status);

    TickLoopSettings settings_;
    TickFunction tick_ = nullptr;
    void* context_ = nullptr;
    TickTrace* trace_ = nullptr;
    RealtimeReport report_;
    AwakeProcessor awake_;
    Thread thread_;
    bool running_ = false;
    std::unique_ptr<TickStatistics> statistics_ = std::make_unique<TickStatistics>();
    std::atomic<bool> ready_{false};
    std::atomic<bool> stop_requested_{false};
    std::atomic<TickStatus> status_{0};
    std::atomic<std::uint64_t> ticks_{0};
    std::atomic<Nanoseconds> time_lost_{0};
};

}  // namespace tactus
