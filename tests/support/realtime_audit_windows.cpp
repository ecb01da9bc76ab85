#include "support/realtime_audit.hpp"

#include <pthread.h>
#include <windows.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <mutex>

namespace tactus::testing {

namespace {

// Of this thread's scope. Neither C++'s own thread_local, which allocates here when a thread first asks for it,
// nor a static of a function, whose guard takes a lock: both would come back here.
std::atomic<DWORD> watching_slot{TLS_OUT_OF_INDEXES};

AuditScope* watching() {
    const DWORD slot = watching_slot.load(std::memory_order_acquire);
    return slot == TLS_OUT_OF_INDEXES ? nullptr : static_cast<AuditScope*>(TlsGetValue(slot));
}

void watch(AuditScope* scope) {
    if (watching_slot.load(std::memory_order_acquire) == TLS_OUT_OF_INDEXES) {
        DWORD none = TLS_OUT_OF_INDEXES;
        const DWORD made = TlsAlloc();
        if (!watching_slot.compare_exchange_strong(none, made)) {
            TlsFree(made);
        }
    }
    TlsSetValue(watching_slot.load(std::memory_order_acquire), scope);
}

// Every lock that is taken while an audit of locks runs. Its own lock is the system's: the wrapped ones would
// come back here.
struct LockTable {
    struct Entry {
        const void* lock = nullptr;
        DWORD first_thread = 0;
        bool by_several = false;
        bool in_scope = false;
    };

    void note(const void* lock, bool in_scope) {
        AcquireSRWLockExclusive(&guard);
        const DWORD thread = GetCurrentThreadId();
        Entry* const end = entries.data() + used;
        Entry* entry = std::find_if(entries.data(), end, [lock](const Entry& e) { return e.lock == lock; });
        if (entry == end && used < entries.size()) {
            *entry = {lock, thread, false, false};
            ++used;
        }
        if (entry != entries.data() + entries.size()) {
            entry->by_several = entry->by_several || entry->first_thread != thread;
            entry->in_scope = entry->in_scope || in_scope;
        }
        ReleaseSRWLockExclusive(&guard);
    }

    std::vector<const void*> taken_in_scope(bool and_by_another_thread) {
        std::vector<const void*> locks;
        for (std::size_t i = 0; i < used; ++i) {
            if (entries[i].in_scope && (entries[i].by_several || !and_by_another_thread)) {
                locks.push_back(entries[i].lock);
            }
        }
        return locks;
    }

    SRWLOCK guard = SRWLOCK_INIT;
    std::array<Entry, 1u << 12> entries{};
    std::size_t used = 0;
};

LockTable lock_table;
std::atomic<bool> lock_audit_runs{false};

}  // namespace

// What the wrapped functions report to. Everything here may run inside malloc: it allocates nothing.
struct Recorder {
    static void allocation() { count(&AuditCounts::allocations); }
    static void release() { count(&AuditCounts::frees); }
    static void wait() { count(&AuditCounts::waits); }
    static void lock(const void* address) {
        if (lock_audit_runs.load(std::memory_order_relaxed)) {
            lock_table.note(address, watching() != nullptr);
        }
        count(&AuditCounts::locks);
    }

private:
    static void count(std::size_t AuditCounts::* figure) {
        AuditScope* const scope = watching();
        if (scope == nullptr) {
            return;
        }
        ++(scope->counts_.*figure);
        if (scope->first_offence_frames_ == 0) {
            scope->first_offence_frames_ =
                CaptureStackBackTrace(0, AuditScope::max_frames, scope->first_offence_.data(), nullptr);
        }
    }
};

}  // namespace tactus::testing

using tactus::testing::Recorder;

// The linker sends every call of NAME to __wrap_NAME (site_scons/toolchain.py lists them).
#define TACTUS_WRAP(RESULT, NAME, PARAMETERS, ARGUMENTS, REPORT) \
    extern "C" RESULT __real_##NAME PARAMETERS;                  \
    extern "C" RESULT __wrap_##NAME PARAMETERS {                 \
        REPORT;                                                  \
        return __real_##NAME ARGUMENTS;                          \
    }

TACTUS_WRAP(void*, malloc, (std::size_t bytes), (bytes), Recorder::allocation())
TACTUS_WRAP(void*, calloc, (std::size_t count, std::size_t bytes), (count, bytes), Recorder::allocation())
TACTUS_WRAP(void*, realloc, (void* block, std::size_t bytes), (block, bytes), {
    Recorder::allocation();
    if (block != nullptr) {
        Recorder::release();
    }
})
TACTUS_WRAP(void, free, (void* block), (block), {
    if (block != nullptr) {
        Recorder::release();
    }
})
TACTUS_WRAP(void*, _aligned_malloc, (std::size_t bytes, std::size_t alignment), (bytes, alignment),
            Recorder::allocation())
TACTUS_WRAP(void, _aligned_free, (void* block), (block), {
    if (block != nullptr) {
        Recorder::release();
    }
})
TACTUS_WRAP(int, pthread_mutex_lock, (pthread_mutex_t * m), (m), Recorder::lock(m))
TACTUS_WRAP(int, pthread_mutex_trylock, (pthread_mutex_t * m), (m), Recorder::lock(m))
TACTUS_WRAP(int, pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m), Recorder::wait())
TACTUS_WRAP(int, pthread_cond_timedwait, (pthread_cond_t * c, pthread_mutex_t* m, const timespec* t),
            (c, m, t), Recorder::wait())
TACTUS_WRAP(int, pthread_join, (pthread_t t, void** r), (t, r), Recorder::wait())

namespace tactus::testing {

bool AuditScope::is_sleep(long) {
    return false;
}

bool AuditScope::watches_system_calls() {
    return false;
}

AuditScope::AuditScope() {
    if (watching() != nullptr) {
        std::abort();
    }
    watch(this);
}

void AuditScope::finish() {
    if (watching_) {
        watch(nullptr);
        watching_ = false;
    }
}

std::vector<long> AuditScope::system_call_numbers() const {
    return {};
}

std::string AuditScope::describe() const {
    std::string text = std::to_string(counts_.allocations) + " allocations, " +
                       std::to_string(counts_.frees) + " frees, " + std::to_string(counts_.locks) +
                       " locks, " + std::to_string(counts_.waits) + " waits, from";
    for (int frame = 0; frame < first_offence_frames_; ++frame) {
        char address[32];
        std::snprintf(address, sizeof address, " %p", first_offence_[static_cast<std::size_t>(frame)]);
        text += address;
    }
    return text;
}

LockAudit::LockAudit() {
    lock_table.used = 0;
    lock_audit_runs.store(true);
}

LockAudit::~LockAudit() {
    lock_audit_runs.store(false);
}

std::vector<const void*> LockAudit::shared_locks() const {
    return lock_table.taken_in_scope(true);
}

std::size_t LockAudit::locks_in_scopes() const {
    return lock_table.taken_in_scope(false).size();
}

}  // namespace tactus::testing
