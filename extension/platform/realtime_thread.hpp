// What the operating system grants a thread that has to be on time: asked for once, by the thread itself,
// before its loop begins. What is refused is said in words; the loop runs all the same.
#pragma once

#include <string>

#include "core/math/types.hpp"

namespace tactus {

inline constexpr int any_processor = -1;
inline constexpr int last_processor = -2;  // of those the process may use: devices mostly interrupt the first
inline constexpr int max_processors = 1024;  // no system here has a number above

struct RealtimeRequest {
    // In real time, 1 … 99: SCHED_FIFO's priority on Linux; Windows and macOS know two or three steps of it.
    // 0: stay with the ordinary scheduler.
    int fifo_priority = 70;
    bool lock_memory = true;      // pages that have been touched are never swapped out or dropped
    int cpu = last_processor;     // to stay on, if real time is granted: a number, or one of the above
    bool keep_awake = true;       // never let that processor sleep, see realtime/awake_processor.hpp
    Nanoseconds timer_slack = 1;  // how late the ordinary scheduler may let a sleep end, to save power; ≥ 1
};

struct RealtimeReport {
    bool fifo = false;  // real time was granted
    int fifo_priority = 0;
    bool short_turns = false;  // the next best of the ordinary scheduler, where real time was refused
    bool memory_locked = false;
    int cpu = any_processor;
    bool kept_awake = false;
    Nanoseconds timer_slack = 0;  // in force; real-time scheduling has none whatever it says
    std::string text;             // one sentence for each request: granted, or refused and why
};

// For the calling thread (memory: the whole process, until the last thread that asked is done with it).
// `keep_awake` is left to the owner of the thread.
RealtimeReport make_thread_realtime(const RealtimeRequest& request);

// Gives back what is the process's and not the thread's.
void release_realtime(const RealtimeReport& report);

// The calling thread gives way to every other one and stays on that processor; false, and nothing is changed,
// where the system refuses.
bool become_idle_on(int cpu);

// Empty, or why a thread that idles would cost this process time that it needs.
std::string why_not_to_idle();

}  // namespace tactus
