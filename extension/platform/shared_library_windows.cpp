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

}  // namespace tactus
