#include <windows.h>

#include "support/emulation.hpp"

namespace tactus::testing {

// Its system library says so.
bool under_wine() {
    return GetProcAddress(GetModuleHandleW(L"ntdll.dll"), "wine_get_version") != nullptr;
}

bool under_qemu() {
    return false;
}

}  // namespace tactus::testing
