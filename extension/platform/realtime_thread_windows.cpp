#include <windows.h>

#include <avrt.h>
#include <psapi.h>

#include "platform/held_by_threads.hpp"
#include "platform/realtime_thread.hpp"
#include "platform/system_message.hpp"

namespace tactus {

namespace {

// The multimedia scheduler runs its threads ahead of all ordinary ones, for four fifths of the time at most.
// Where its service is off, the highest ordinary priority is the next best.
void request_scheduling(int priority, RealtimeReport& report) {
    if (priority <= 0) {
        report.text += "Scheduling: ordinary, as asked for. ";
        return;
    }
    constexpr int of_the_loop = 70;  // what waits for the loop comes after it
    DWORD task = 0;
    const HANDLE granted = AvSetMmThreadCharacteristicsW(L"Pro Audio", &task);
    if (granted == nullptr) {
        const std::string why = last_system_message();
        report.short_turns = SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_TIME_CRITICAL) != 0;
        report.text += std::string("Scheduling: ordinary") + (report.short_turns ? ", time critical" : "") +
                       "; MMCSS was refused (" + why +
                       "): start the service \"Multimedia Class Scheduler\". ";
        return;
    }
    const bool first = priority >= of_the_loop;
    AvSetMmThreadPriority(granted, first ? AVRT_PRIORITY_CRITICAL : AVRT_PRIORITY_HIGH);
    report.fifo = true;
    report.fifo_priority = priority;
    report.text += std::string("Scheduling: MMCSS, Pro Audio, ") + (first ? "critical" : "high") + ". ";
}

// Windows locks no process as a whole. What it keeps in place is the smallest working set, which is set to
// what the process uses now and some room; the stack of the loop is locked besides.
HeldByThreads kept_memory;
SIZE_T usual_least = 0, usual_most = 0;

std::string keep_working_set(bool is_first) {
    const HANDLE process = GetCurrentProcess();
    DWORD flags = 0;
    PROCESS_MEMORY_COUNTERS use{};
    SIZE_T least = 0, most = 0;
    constexpr SIZE_T room = SIZE_T{64} << 20;
    if (GetProcessWorkingSetSizeEx(process, &least, &most, &flags) == 0 ||
        GetProcessMemoryInfo(process, &use, sizeof use) == 0 ||
        SetProcessWorkingSetSizeEx(process, use.WorkingSetSize + room, use.WorkingSetSize + 2 * room,
                                   QUOTA_LIMITS_HARDWS_MIN_ENABLE | QUOTA_LIMITS_HARDWS_MAX_DISABLE) == 0) {
        return last_system_message();
    }
    if (is_first) {
        usual_least = least;
        usual_most = most;
    }
    return {};
}

void give_back_working_set() {
    SetProcessWorkingSetSizeEx(GetCurrentProcess(), usual_least, usual_most,
                               QUOTA_LIMITS_HARDWS_MIN_DISABLE | QUOTA_LIMITS_HARDWS_MAX_DISABLE);
}

// The pages of this thread's stack that are there. They are let go with the thread.
std::string lock_stack() {
    MEMORY_BASIC_INFORMATION pages{};
    const char here = 0;
    const bool locked = VirtualQuery(&here, &pages, sizeof pages) != 0 &&
                        VirtualLock(pages.BaseAddress, pages.RegionSize) != 0;
    return locked ? std::string() : last_system_message();
}

void request_memory_lock(bool wanted, RealtimeReport& report) {
    if (!wanted) {
        report.text += "Memory: not locked, as asked for. ";
        return;
    }
    std::string refused = kept_memory.hold(&keep_working_set);
    if (refused.empty() && !(refused = lock_stack()).empty()) {
        kept_memory.let_go(&give_back_working_set);
    }
    if (!refused.empty()) {
        report.text += "Memory: not locked (" + refused + "). ";
        return;
    }
    report.memory_locked = true;
    report.text += "Memory: locked, the stack; kept, what was in use and 64 MB. ";
}

DWORD_PTR allowed_processors() {
    DWORD_PTR allowed = 0, of_the_system = 0;
    GetProcessAffinityMask(GetCurrentProcess(), &allowed, &of_the_system);
    return allowed;
}

constexpr int mask_bits = static_cast<int>(8 * sizeof(DWORD_PTR));

int last_allowed_processor() {
    const DWORD_PTR allowed = allowed_processors();
    int cpu = mask_bits - 1;
    while (cpu >= 0 && (allowed >> cpu & 1u) == 0) {
        --cpu;
    }
    return cpu;  // any_processor where none is named: in more than one group of processors
}

// The processors it might run on before, or 0 where it is refused.
DWORD_PTR stay_on(int cpu) {
    return cpu >= 0 && cpu < mask_bits ? SetThreadAffinityMask(GetCurrentThread(), DWORD_PTR{1} << cpu) : 0;
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
    if (stay_on(cpu) == 0) {
        report.text += "Processor: any; number " + std::to_string(cpu) + " was refused. ";
        return;
    }
    report.cpu = cpu;
    report.text += "Processor: number " + std::to_string(cpu) + " only. ";
}

}  // namespace

RealtimeReport make_thread_realtime(const RealtimeRequest& request) {
    RealtimeReport report;
    request_scheduling(request.fifo_priority, report);
    request_memory_lock(request.lock_memory, report);
    request_processor(request.cpu, report);
    report.text.pop_back();
    return report;
}

void release_realtime(const RealtimeReport& report) {
    if (report.memory_locked) {
        kept_memory.let_go(&give_back_working_set);
    }
}

bool become_idle_on(int cpu) {
    const DWORD_PTR before = stay_on(cpu);
    if (before == 0) {
        return false;
    }
    if (SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_IDLE) == 0) {
        SetThreadAffinityMask(GetCurrentThread(), before);
        return false;
    }
    return true;
}

std::string why_not_to_idle() {
    return {};
}

}  // namespace tactus
