#include <process.h>
#include <windows.h>

#include <cerrno>
#include <cstring>

#include "platform/thread.hpp"

namespace tactus {

struct Thread::Entry {
    static unsigned __stdcall enter(void* thread) {
        static_cast<Thread*>(thread)->begin();
        return 0;
    }
};

// The program that has loaded the library chose the usual size of a stack: the loop needs one that it knows.
std::string Thread::create() {
    constexpr unsigned stack_bytes = 8u << 20;
    system_thread_ =
        _beginthreadex(nullptr, stack_bytes, &Entry::enter, this, STACK_SIZE_PARAM_IS_A_RESERVATION, nullptr);
    return system_thread_ != 0 ? std::string() : std::strerror(errno);
}

void Thread::wait_for_end() {
    const auto handle = reinterpret_cast<HANDLE>(system_thread_);
    WaitForSingleObject(handle, INFINITE);
    CloseHandle(handle);
}

void Thread::let_run() {
    CloseHandle(reinterpret_cast<HANDLE>(system_thread_));
}

}  // namespace tactus
