#include <mach/mach.h>
#include <mach/mach_time.h>
#include <mach/thread_policy.h>

#include "platform/realtime_thread.hpp"

namespace tactus {

namespace {

std::uint32_t policy_units(Nanoseconds span) {
    mach_timebase_info_data_t base{};
    mach_timebase_info(&base);
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(span) * base.denom / base.numer);
}

// A promise of how much time is needed and how soon: the scheduler takes it back from a thread that breaks
// it.
void request_scheduling(int priority, RealtimeReport& report) {
    if (priority <= 0) {
        report.text += "Scheduling: ordinary, as asked for. ";
        return;
    }
    thread_time_constraint_policy_data_t promise{};
    promise.period = policy_units(1'000'000);
    promise.computation = policy_units(300'000);
    promise.constraint = policy_units(600'000);
    promise.preemptible = 1;
    const kern_return_t code =
        thread_policy_set(mach_thread_self(), THREAD_TIME_CONSTRAINT_POLICY,
                          reinterpret_cast<thread_policy_t>(&promise), THREAD_TIME_CONSTRAINT_POLICY_COUNT);
    if (code != KERN_SUCCESS) {
        report.text += "Scheduling: ordinary; time constraints were refused. ";
        return;
    }
    report.fifo = true;
    report.fifo_priority = priority;
    report.text += "Scheduling: by time constraint. ";
}

}  // namespace

// The system compresses memory before it swaps any, locks no process as a whole and binds no thread.
RealtimeReport make_thread_realtime(const RealtimeRequest& request) {
    RealtimeReport report;
    request_scheduling(request.fifo_priority, report);
    report.text += request.lock_memory ? "Memory: not locked, macOS has no such thing. "
                                       : "Memory: not locked, as asked for. ";
    report.text += "Processor: any.";
    return report;
}

void release_realtime(const RealtimeReport&) {}

bool become_idle_on(int) {
    return false;
}

std::string why_not_to_idle() {
    return {};
}

}  // namespace tactus
