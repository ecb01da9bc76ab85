#include <pthread.h>
#include <windows.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "support/realtime_audit_system.hpp"

namespace tactus::testing {

namespace {

// Of this thread's scope. Neither C++'s own thread_local, which allocates here when a thread first asks for
// it, nor a static of a function, whose guard takes a lock: both would come back here.
std::atomic<DWORD> watching_slot{TLS_OUT_OF_INDEXES};

}  // namespace

Watch watch() {
    const DWORD slot = watching_slot.load(std::memory_order_acquire);
    return {slot == TLS_OUT_OF_INDEXES ? nullptr : static_cast<AuditScope*>(TlsGetValue(slot))};
}

void set_watch(Watch wanted) {
    TlsSetValue(watching_slot.load(std::memory_order_acquire), wanted.scope);
}

void prepare_audit() {
    if (watching_slot.load(std::memory_order_acquire) == TLS_OUT_OF_INDEXES) {
        DWORD none = TLS_OUT_OF_INDEXES;
        const DWORD made = TlsAlloc();
        if (!watching_slot.compare_exchange_strong(none, made)) {
            TlsFree(made);
        }
    }
}

std::uintptr_t thread_number() {
    return GetCurrentThreadId();
}

int back_trace(void** frames, int most) {
    return CaptureStackBackTrace(0, static_cast<DWORD>(most), frames, nullptr);
}

std::string names_of(void* const* frames, int count) {
    std::string text = ", from";
    for (int frame = 0; frame < count; ++frame) {
        char address[32];
        std::snprintf(address, sizeof address, " %p", frames[frame]);
        text += address;
    }
    return text;
}

bool AuditScope::is_sleep(long) {
    return false;
}

bool AuditScope::watches_system_calls() {
    return false;
}

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
TACTUS_WRAP(int, pthread_mutex_lock, (pthread_mutex_t * m), (m), Recorder::lock(m))
TACTUS_WRAP(int, pthread_mutex_trylock, (pthread_mutex_t * m), (m), Recorder::lock(m))
TACTUS_WRAP(int, pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m), Recorder::wait())
TACTUS_WRAP(int, pthread_cond_timedwait, (pthread_cond_t * c, pthread_mutex_t* m, const timespec* t),
            (c, m, t), Recorder::wait())
TACTUS_WRAP(int, pthread_join, (pthread_t t, void** r), (t, r), Recorder::wait())

// Of these the callers know the library's table alone, in which the function's address stands.
#define TACTUS_WRAP_IMPORTED(RESULT, NAME, PARAMETERS, ARGUMENTS, REPORT) \
    extern "C" {                                                          \
    extern RESULT(*__real___imp_##NAME) PARAMETERS;                       \
    static RESULT watched_##NAME PARAMETERS {                             \
        REPORT;                                                           \
        return __real___imp_##NAME ARGUMENTS;                             \
    }                                                                     \
    RESULT(*__wrap___imp_##NAME) PARAMETERS = &watched_##NAME;            \
    }

TACTUS_WRAP_IMPORTED(void*, _aligned_malloc, (std::size_t bytes, std::size_t alignment), (bytes, alignment),
                     Recorder::allocation())
TACTUS_WRAP_IMPORTED(void, _aligned_free, (void* block), (block), {
    if (block != nullptr) {
        Recorder::release();
    }
})
TACTUS_WRAP_IMPORTED(void, AcquireSRWLockExclusive, (SRWLOCK * l), (l), Recorder::lock(l))
TACTUS_WRAP_IMPORTED(void, AcquireSRWLockShared, (SRWLOCK * l), (l), Recorder::lock(l))
TACTUS_WRAP_IMPORTED(BOOLEAN, TryAcquireSRWLockExclusive, (SRWLOCK * l), (l), Recorder::lock(l))
TACTUS_WRAP_IMPORTED(BOOLEAN, TryAcquireSRWLockShared, (SRWLOCK * l), (l), Recorder::lock(l))
