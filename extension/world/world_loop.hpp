// Who ticks a session, and its clock: the haptic thread in real time, or the owner, as many ticks at a time
// as it likes. The session's clock starts at zero and stands still while nothing ticks.
//
// Threads: all belongs to the session's owner; ticks() and *ahead() may be read by anybody.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "realtime/baseline_loop.hpp"
#include "realtime/tick_loop.hpp"
#include "session/session.hpp"

namespace tactus {

class WorldLoop {
public:
    // The session outlives the loop.
    WorldLoop(Session& session, bool real_time);
    ~WorldLoop() { stop(); }
    WorldLoop(const WorldLoop&) = delete;
    WorldLoop& operator=(const WorldLoop&) = delete;

    // Real time only. The text is empty, or why the loop could not start. With `baseline` a bare loop runs
    // beside. Other settings later: stop and start; the session's clock goes on where it was.
    std::string start(const TickLoopSettings& settings, bool baseline);
    void stop();
    bool is_running() const { return loop_.running(); }
    const TickLoopSettings& settings() const { return settings_; }  // as it was started last
    // A thread of its own makes the ticks, or will.
    bool is_real_time() const { return real_time_; }

    // Stepped time: ticks at once, here. `between` is called now and then, before any ring is full.
    void advance(std::int64_t ticks, const std::function<void()>& between);
    // One tick, here; nobody else ticks.
    void tick_once() { tick(next_time_, 0); }

    // Every tick is timed from now on. Empty text, or why the loop could not go on.
    std::string trace_ticks();
    TickTrace* trace() { return trace_.get(); }  // null: nothing is timed

    std::uint64_t ticks() const { return ticks_.load(std::memory_order_acquire); }
    // Of the session.
    Nanoseconds now() const { return static_cast<Nanoseconds>(ticks()) * session_.settings().period; }
    // The OR of all ticks' statuses since the last call.
    TickStatus take_status() { return real_time_ ? loop_.take_status() : std::exchange(stepped_status_, 0u); }
    // What the machine's monotonic clock is ahead of the session's; null in stepped time.
    const std::atomic<Nanoseconds>* ahead() const { return real_time_ ? &ahead_ : nullptr; }
    // The zero of the session's clock, since 1970; in stepped time that clock is not of this world, and it is
    // zero.
    Nanoseconds epoch() const;

    TickLoop& loop() { return loop_; }
    const TickLoop& loop() const { return loop_; }
    BaselineLoop* baseline() { return baseline_.get(); }  // null: none runs

private:
    static TickStatus tick_function(void* self, Nanoseconds scheduled);
    TickStatus tick(Nanoseconds now, Nanoseconds late);

    Session& session_;
    bool real_time_;
    std::unique_ptr<TickTrace> trace_;
    TickLoopSettings settings_;  // as it was started last
    std::unique_ptr<BaselineLoop> baseline_;

    std::atomic<Nanoseconds> ahead_{0};
    std::atomic<std::uint64_t> ticks_{0};
    Nanoseconds next_time_ = 0;             // of the session, for the next tick
    bool is_new_ = true;                    // the loop's first tick says where it is on its clock
    Nanoseconds epoch_of_monotonic_clock_;  // its zero, since 1970
    TickStatus stepped_status_ = 0;
    TickLoop loop_;  // last: it stops before what it uses goes
};

}  // namespace tactus
