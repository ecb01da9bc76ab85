#include <windows.h>

#include <array>

#include "platform/shared_library.hpp"
#include "platform/system_message.hpp"
#include "platform/wide_text_windows.hpp"

namespace tactus {

void* function_of_library(const std::string& library, const char* name, std::string& error) {
    const HMODULE loaded = LoadLibraryW(windows::to_wide(library).c_str());
    const FARPROC function = loaded != nullptr ? GetProcAddress(loaded, name) : nullptr;
    if (function == nullptr) {
        error = library + ": " + system_message(static_cast<int>(GetLastError()));
    }
    return reinterpret_cast<void*>(function);
}

std::string path_of_this_library(const void* inside) {
    HMODULE module = nullptr;
    constexpr DWORD by_address =
        GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    std::array<wchar_t, 32768> path{};  // the longest that there is
    if (GetModuleHandleExW(by_address, static_cast<const wchar_t*>(inside), &module) == 0 ||
        GetModuleFileNameW(module, path.data(), static_cast<DWORD>(path.size())) == 0) {
        return "";
    }
    return windows::to_utf8(path.data());
}

}  // namespace tactus
