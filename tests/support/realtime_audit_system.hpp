// Between realtime_audit.cpp, which counts, and the one file of each system that stands in front of its C
// library. All of it may run inside malloc: it allocates nothing and takes no lock that is watched.
#pragma once

#include <cstdint>
#include <string>

#include "support/realtime_audit.hpp"

namespace tactus::testing {

// --- What each system answers ---

// What of a thread is watched.
struct Watch {
    AuditScope* scope = nullptr;  // that counts it
    bool system_calls = false;
};

Watch watch();  // of this thread
void set_watch(Watch wanted);

// Before a thread's first scope: whatever the audit needs is loaded by now, not in the middle of it.
void prepare_audit();

std::uintptr_t thread_number();  // not 0
int back_trace(void** frames, int most);
std::string names_of(void* const* frames, int count);

// --- What the functions in front report ---

struct Recorder {
    static void allocation() { count(&AuditCounts::allocations); }
    static void release() { count(&AuditCounts::frees); }
    static void wait() { count(&AuditCounts::waits); }
    static void lock(const void* address);
    static void system_call(long number);

private:
    static void count(std::size_t AuditCounts::* figure);
};

// Held while the audit itself runs, whose own doings are nobody's offence.
class Unwatched {
public:
    Unwatched() : before_(watch()) { set_watch({}); }
    ~Unwatched() { set_watch(before_); }
    Unwatched(const Unwatched&) = delete;
    Unwatched& operator=(const Unwatched&) = delete;

private:
    Watch before_;
};

}  // namespace tactus::testing
