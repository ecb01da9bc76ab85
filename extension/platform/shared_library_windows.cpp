#include <windows.h>

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

namespace {

std::string file_of(HMODULE module) {
    std::wstring path(32768, L'\0');  // the longest that there is
    const DWORD length = GetModuleFileNameW(module, path.data(), static_cast<DWORD>(path.size()));
    return windows::to_utf8(path.substr(0, length));
}

}  // namespace

std::string file_of_library(const std::string& library) {
    const HMODULE loaded = LoadLibraryW(windows::to_wide(library).c_str());
    if (loaded == nullptr) {
        return "";
    }
    const std::string file = file_of(loaded);
    FreeLibrary(loaded);
    return file;
}

std::string path_of_this_library(const void* inside) {
    constexpr DWORD by_address =
        GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    HMODULE module = nullptr;
    const bool found = GetModuleHandleExW(by_address, static_cast<const wchar_t*>(inside), &module) != 0;
    return found ? file_of(module) : "";
}

void keep_this_library() {
    HMODULE module = nullptr;
    GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_PIN,
                       reinterpret_cast<const wchar_t*>(&keep_this_library), &module);
}

}  // namespace tactus
