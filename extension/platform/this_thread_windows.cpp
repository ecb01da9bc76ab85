#include "platform/this_thread.hpp"

#include <windows.h>

#include <bit>

#include "platform/wide_text_windows.hpp"

namespace tactus {

// Asked for by name: Windows before 10 (1607) has no names of threads.
void name_this_thread(const char* name) {
    using SetDescription = HRESULT(WINAPI*)(HANDLE, PCWSTR);
    const FARPROC found = GetProcAddress(GetModuleHandleW(L"kernel32.dll"), "SetThreadDescription");
    if (found != nullptr) {
        reinterpret_cast<SetDescription>(reinterpret_cast<void*>(found))(GetCurrentThread(),
                                                                         windows::to_wide(name).c_str());
    }
}

void work_in_background() {
    SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL);
}

void keep_off_last_processor(bool keeps_off) {
    DWORD_PTR processors = 0, of_system = 0;
    if (GetProcessAffinityMask(GetCurrentProcess(), &processors, &of_system) == 0) {
        return;
    }
    const DWORD_PTR others = processors & ~std::bit_floor(processors);
    SetThreadAffinityMask(GetCurrentThread(), keeps_off && others != 0 ? others : processors);
}

}  // namespace tactus
