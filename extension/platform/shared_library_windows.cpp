#include <windows.h>

#include "platform/shared_library.hpp"
#include "platform/system_message.hpp"

namespace tactus {

void* function_of_library(const std::filesystem::path& library, const char* name, std::string& error) {
    const HMODULE loaded = LoadLibraryW(library.c_str());
    const FARPROC function = loaded != nullptr ? GetProcAddress(loaded, name) : nullptr;
    if (function == nullptr) {
        error = library.string() + ": " + system_message(static_cast<int>(GetLastError()));
    }
    return reinterpret_cast<void*>(function);
}

}  // namespace tactus
