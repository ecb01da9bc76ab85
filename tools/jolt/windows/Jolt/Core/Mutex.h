// Stands in front of Jolt's header of this name in builds for Windows: gcc's locks allocate there when they
// are first taken, and that would be in the loop. The system's own need nothing but a pointer's room.
#pragma once

#include <Jolt/Core/NonCopyable.h>
#include <Jolt/Core/Profiler.h>

#include <mutex>
#include <shared_mutex>
#include <thread>

// As windows.h declares them, whose macros would be in the way.
struct _RTL_SRWLOCK;
extern "C" {
__declspec(dllimport) void __stdcall AcquireSRWLockExclusive(_RTL_SRWLOCK*);
__declspec(dllimport) void __stdcall AcquireSRWLockShared(_RTL_SRWLOCK*);
__declspec(dllimport) unsigned char __stdcall TryAcquireSRWLockExclusive(_RTL_SRWLOCK*);
__declspec(dllimport) unsigned char __stdcall TryAcquireSRWLockShared(_RTL_SRWLOCK*);
__declspec(dllimport) void __stdcall ReleaseSRWLockExclusive(_RTL_SRWLOCK*);
__declspec(dllimport) void __stdcall ReleaseSRWLockShared(_RTL_SRWLOCK*);
}

JPH_NAMESPACE_BEGIN

using std::lock_guard;
using std::mutex;
using std::shared_lock;
using std::shared_mutex;
using std::thread;
using std::unique_lock;

class SharedMutex : public NonCopyable {
public:
    void lock() { AcquireSRWLockExclusive(system()); }
    bool try_lock() { return TryAcquireSRWLockExclusive(system()) != 0; }
    void unlock() { ReleaseSRWLockExclusive(system()); }
    void lock_shared() { AcquireSRWLockShared(system()); }
    bool try_lock_shared() { return TryAcquireSRWLockShared(system()) != 0; }
    void unlock_shared() { ReleaseSRWLockShared(system()); }

private:
    _RTL_SRWLOCK* system() { return reinterpret_cast<_RTL_SRWLOCK*>(&state_); }

    void* state_ = nullptr;  // free: SRWLOCK_INIT
};

using Mutex = SharedMutex;

JPH_NAMESPACE_END
