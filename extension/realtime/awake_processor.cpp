#include "realtime/awake_processor.hpp"

#include "platform/clock.hpp"
#include "platform/processor.hpp"
#include "platform/realtime_thread.hpp"
#include "platform/sleep.hpp"
#include "realtime/workers.hpp"

namespace tactus {

std::string AwakeProcessor::start(int cpu, const AwakeTimes& times) {
    stop();
    if (cpu < 0 || cpu >= max_processors) {
        return "the thread is not bound to one processor";
    }
    if (std::string reason = why_not_to_idle(); !reason.empty()) {
        return reason;
    }
    running_ = std::make_shared<Running>();
    running_->cpu = cpu;
    running_->times = times;
    return running_->thread.start("tactus-awake", &AwakeProcessor::run, running_.get());
}

// A thread of idle priority ends when nothing else wants its processor: nobody waits for that here.
void AwakeProcessor::stop() {
    if (const std::shared_ptr<Running> last = std::move(running_)) {
        last->stop_requested.store(true, std::memory_order_relaxed);
        Workers::discard([last] { last->thread.join(); });
    }
}

void AwakeProcessor::run(void* self) {
    const Running& own = *static_cast<Running*>(self);
    if (!become_idle_on(own.cpu)) {
        return;
    }
    const AwakeTimes& times = own.times;
    SleepTimer timer;
    Nanoseconds now = monotonic_now();
    while (!own.stop_requested.load(std::memory_order_relaxed)) {
        const Nanoseconds deadline = ((now - times.phase) / times.period + 1) * times.period + times.phase;
        if (now < deadline - times.lead) {
            timer.sleep_until(deadline - times.lead);
        }
        do {
            relax_processor();
            now = monotonic_now();
        } while (now < deadline && !own.stop_requested.load(std::memory_order_relaxed));
    }
}

}  // namespace tactus
