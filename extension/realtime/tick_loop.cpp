#include "realtime/tick_loop.hpp"

#include <cstring>

#include "platform/atomic_wait.hpp"
#include "platform/clock.hpp"
#include "realtime/thread_role.hpp"
#include "realtime/tick_schedule.hpp"
#include "realtime/workers.hpp"

namespace tactus {

namespace {

// Far enough ahead that it is not late before the loop has begun.
Nanoseconds first_deadline(Nanoseconds now, const TickLoopSettings& settings) {
    return (now / settings.period + 2) * settings.period + settings.phase;
}

// Touches the stack that ticks are going to use: no page of it is fetched later, in the middle of a tick.
[[gnu::noinline]] void touch_stack() {
    constexpr std::size_t depth = 256 * 1024;
    char stack[depth];
    std::memset(stack, 0, depth);
    asm volatile("" : : "r"(stack) : "memory");  // keeps the otherwise unused array
}

}  // namespace

std::string TickLoop::start(const TickLoopSettings& settings, TickFunction tick, void* context,
                            TickTrace* trace) {
    if (running_) {
        return "the loop is running already";
    }
    if (settings.period <= 0) {
        return "the tick period has to be above zero";
    }
    settings_ = settings;
    tick_ = tick;
    context_ = context;
    trace_ = trace;
    statistics_ = std::make_unique<TickStatistics>();
    ready_.store(false, std::memory_order_relaxed);
    stop_requested_.store(false, std::memory_order_relaxed);
    status_.store(0, std::memory_order_relaxed);
    ticks_.store(0, std::memory_order_relaxed);
    time_lost_.store(0, std::memory_order_relaxed);

    const std::string refused =
        thread_.start(settings_.thread_name, [](void* loop) { static_cast<TickLoop*>(loop)->run(); }, this);
    if (!refused.empty()) {
        return "the haptic thread could not be created: " + refused;
    }
    wait_while(ready_, false);
    running_ = true;
    keep_awake();
    return {};
}

void TickLoop::keep_awake() {
    if (!settings_.realtime.keep_awake) {
        report_.text += " It may sleep, as asked for.";
        return;
    }
    const std::string refused = awake_.start(
        report_.cpu, {.period = settings_.period, .phase = settings_.phase, .lead = settings_.awake_lead});
    report_.kept_awake = refused.empty();
    report_.text += refused.empty() ? " It is kept awake." : " It may sleep: " + refused + ".";
}

void TickLoop::stop() {
    if (!running_) {
        return;
    }
    stop_requested_.store(true, std::memory_order_release);
    thread_.join();
    running_ = false;
    awake_.stop();
    // All pages of the process are gone through for it, for tens of milliseconds where there are many.
    Workers::discard([report = report_] { release_realtime(report); });
}

void TickLoop::run() {
    const HapticRole role;
    report_ = make_thread_realtime(settings_.realtime);
    touch_stack();
    ready_.store(true, std::memory_order_release);
    wake_all(ready_);

    Sleeper sleeper(settings_.sleep);
    TickSchedule schedule(first_deadline(monotonic_now(), settings_), settings_.period,
                          settings_.rebase_after);
    for (;;) {
        const Nanoseconds start = sleeper.wait_until(schedule.deadline());
        if (stop_requested_.load(std::memory_order_acquire)) {
            return;
        }
        const Nanoseconds lost = schedule.rebase_if_hopeless(start);
        if (lost > 0) {
            time_lost_.fetch_add(lost, std::memory_order_relaxed);
        }
        const Nanoseconds scheduled = schedule.deadline();
        schedule.advance();
        run_tick(scheduled, start, schedule.deadline(), lost > 0 ? tick_rebased : 0);
    }
}

void TickLoop::run_tick(Nanoseconds scheduled, Nanoseconds start, Nanoseconds due_next, TickStatus status) {
    if (trace_ != nullptr) {
        trace_->begin_tick(scheduled, start);
    }
    status |= tick_(context_, scheduled);
    const Nanoseconds end = monotonic_now();
    if (end > due_next) {
        status |= tick_late;
    }
    if (trace_ != nullptr) {
        trace_->end_tick(end, status);
    }
    statistics_->add(scheduled, start, end, due_next);
    if (status != 0) {
        status_.fetch_or(status, std::memory_order_acq_rel);
    }
    ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

}  // namespace tactus
