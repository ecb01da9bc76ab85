#include "realtime/awake_processor.hpp"

#include "platform/processor.hpp"
#include "platform/realtime_thread.hpp"

namespace tactus {

std::string AwakeProcessor::start(int cpu) {
    stop();
    if (cpu < 0 || cpu >= max_processors) {
        return "the thread is not bound to one processor";
    }
    if (std::string reason = why_not_to_idle(); !reason.empty()) {
        return reason;
    }
    cpu_ = cpu;
    stop_requested_.store(false, std::memory_order_relaxed);
    return thread_.start("tactus-awake", &AwakeProcessor::run, this);
}

void AwakeProcessor::stop() {
    stop_requested_.store(true, std::memory_order_relaxed);
    thread_.join();
}

void AwakeProcessor::run(void* self) {
    const AwakeProcessor& awake = *static_cast<AwakeProcessor*>(self);
    if (!become_idle_on(awake.cpu_)) {
        return;
    }
    while (!awake.stop_requested_.load(std::memory_order_relaxed)) {
        relax_processor();
    }
}

}  // namespace tactus
