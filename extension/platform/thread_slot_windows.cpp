#include <windows.h>

#include "platform/thread_slot.hpp"

namespace tactus {

namespace {

// When the library is loaded: the first 64 of a process have their room in every thread.
const DWORD index = TlsAlloc();

}  // namespace

void* thread_slot() {
    return TlsGetValue(index);
}

void set_thread_slot(void* value) {
    TlsSetValue(index, value);
}

}  // namespace tactus
