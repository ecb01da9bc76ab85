#include "platform/realtime_thread.hpp"

#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <fstream>

#include "platform/control_group_linux.hpp"
#include "platform/held_by_threads.hpp"
#include "platform/system_message.hpp"

namespace tactus {

namespace {

HeldByThreads locked_memory;

bool has_capability(int capability) {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3] = {};
    if (syscall(SYS_capget, &header, data) != 0) {
        return false;
    }
    const auto bit = static_cast<unsigned>(capability);
    return (data[bit / 32].effective >> (bit % 32) & 1u) != 0;
}

// Under a finite limit locking must not be tried at all: once it had succeeded, the first allocation of the
// process beyond the limit would fail.
bool may_lock_everything() {
    rlimit limit{};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    return limit.rlim_cur == RLIM_INFINITY || has_capability(CAP_IPC_LOCK);
}

// What sched_getattr and sched_setattr take, in the kernel's first version of it.
struct SchedulingAttributes {
    std::uint32_t size;
    std::uint32_t policy;
    std::uint64_t flags;
    std::int32_t nice;
    std::uint32_t priority;
    std::uint64_t runtime;  // for the ordinary scheduler: the length of a turn (unit: nanoseconds)
    std::uint64_t deadline;
    std::uint64_t period;
};
static_assert(sizeof(SchedulingAttributes) == 48);

// Who asks for short turns gets them sooner: since Linux 6.12 a thread may choose its own, and older kernels
// change nothing. Beside three busy threads on two processors nine of ten wake-ups came within 25 µs instead
// of 70 to 420 µs.
bool request_short_turns() {
    constexpr std::uint64_t shortest = 100'000;
    SchedulingAttributes attributes{};
    if (syscall(SYS_sched_getattr, 0, &attributes, sizeof(attributes), 0) != 0) {
        return false;
    }
    attributes.size = sizeof(attributes);
    attributes.runtime = shortest;
    if (syscall(SYS_sched_setattr, 0, &attributes, 0) != 0) {
        return false;
    }
    SchedulingAttributes in_force{};
    syscall(SYS_sched_getattr, 0, &in_force, sizeof(in_force), 0);
    return in_force.runtime == shortest;
}

void request_scheduling(int priority, RealtimeReport& report) {
    if (priority <= 0) {
        report.text += "Scheduling: ordinary, as asked for. ";
        return;
    }
    const sched_param parameters{priority};
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    if (error != 0) {
        report.short_turns = request_short_turns();
        report.text += std::string("Scheduling: ordinary") + (report.short_turns ? ", in short turns" : "") +
                       "; SCHED_FIFO " + std::to_string(priority) + " was refused (" + system_message(error) +
                       "): raise this user's rtprio limit. ";
        return;
    }
    report.fifo = true;
    report.fifo_priority = priority;
    report.text += "Scheduling: SCHED_FIFO, priority " + std::to_string(priority) + ". ";
}

// Locked as it is touched: an engine reserves far more than it uses, and what the loop uses has been touched
// before.
void request_memory_lock(bool wanted, RealtimeReport& report) {
    if (!wanted) {
        report.text += "Memory: not locked, as asked for. ";
        return;
    }
    if (!may_lock_everything()) {
        report.text += "Memory: not locked; this user's memlock limit is finite: raise it to unlimited. ";
        return;
    }
    const std::string refused = locked_memory.hold([](bool) {
        const bool locked = mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
        return locked ? std::string() : last_system_message();
    });
    if (!refused.empty()) {
        report.text += "Memory: not locked (" + refused + "). ";
        return;
    }
    report.memory_locked = true;
    report.text += "Memory: locked as it is touched. ";
}

int last_allowed_processor() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    sched_getaffinity(0, sizeof(allowed), &allowed);
    for (int cpu = CPU_SETSIZE - 1; cpu >= 0; --cpu) {
        if (CPU_ISSET(static_cast<std::size_t>(cpu), &allowed)) {
            return cpu;
        }
    }
    return any_processor;
}

void request_processor(int wanted, RealtimeReport& report) {
    if (wanted == any_processor) {
        report.text += "Processor: any, as asked for. ";
        return;
    }
    if (!report.fifo) {
        report.text += "Processor: any; on one alone an ordinary thread would queue behind others. ";
        return;
    }
    const int cpu = wanted == last_processor ? last_allowed_processor() : wanted;
    int error = EINVAL;
    if (cpu >= 0 && cpu < CPU_SETSIZE) {
        cpu_set_t only;
        CPU_ZERO(&only);
        CPU_SET(static_cast<std::size_t>(cpu), &only);
        error = pthread_setaffinity_np(pthread_self(), sizeof(only), &only);
    }
    if (error != 0) {
        report.text += "Processor: any; number " + std::to_string(cpu) + " was refused (" +
                       system_message(error) + "). ";
        return;
    }
    report.cpu = cpu;
    report.text += "Processor: number " + std::to_string(cpu) + " only. ";
}

void request_timer_slack(Nanoseconds slack, RealtimeReport& report) {
    prctl(PR_SET_TIMERSLACK, static_cast<unsigned long>(slack), 0, 0, 0);
    report.timer_slack = prctl(PR_GET_TIMERSLACK, 0, 0, 0, 0);
    report.text += "Timer slack: " + std::to_string(report.timer_slack) + " ns.";
}

}  // namespace

// The slack first: a thread that is scheduled in real time has none to set.
RealtimeReport make_thread_realtime(const RealtimeRequest& request) {
    RealtimeReport report;
    request_timer_slack(request.timer_slack, report);
    report.text += " ";
    request_scheduling(request.fifo_priority, report);
    request_memory_lock(request.lock_memory, report);
    request_processor(request.cpu, report);
    report.text.pop_back();
    return report;
}

void release_realtime(const RealtimeReport& report) {
    if (report.memory_locked) {
        locked_memory.let_go([] { munlockall(); });
    }
}

// Idle priority on one processor, or nothing: at any other priority this thread would be in the way.
bool become_idle_on(int cpu) {
    if (cpu < 0 || cpu >= CPU_SETSIZE) {
        return false;
    }
    cpu_set_t before, only;
    CPU_ZERO(&only);
    CPU_SET(static_cast<std::size_t>(cpu), &only);
    if (pthread_getaffinity_np(pthread_self(), sizeof(before), &before) != 0 ||
        pthread_setaffinity_np(pthread_self(), sizeof(only), &only) != 0) {
        return false;
    }
    const sched_param parameters{0};
    if (pthread_setschedparam(pthread_self(), SCHED_IDLE, &parameters) != 0) {
        pthread_setaffinity_np(pthread_self(), sizeof(before), &before);
        return false;
    }
    return true;
}

std::string why_not_to_idle() {
    std::ifstream file("/sys/fs/cgroup/cpu.max");
    std::string allowance;
    std::getline(file, allowance);
    return limits_processor_time(allowance) ? "this process's processor time is limited" : "";
}

// "max 100000" or "200000 100000": allowance and period in microseconds.
bool limits_processor_time(const std::string& cpu_max) {
    return !cpu_max.empty() && cpu_max.rfind("max", 0) != 0;
}

}  // namespace tactus
