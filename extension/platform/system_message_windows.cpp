#include "platform/system_message.hpp"

#include <windows.h>

#include "platform/wide_text_windows.hpp"

namespace tactus {

std::string system_message(int code) {
    wchar_t text[512];
    const DWORD length =
        FormatMessageW(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS, nullptr,
                       static_cast<DWORD>(code), 0, text, static_cast<DWORD>(std::size(text)), nullptr);
    std::wstring message(text, length);
    message.erase(message.find_last_not_of(L" .\r\n") + 1);
    return message.empty() ? "error " + std::to_string(code) : windows::to_utf8(message);
}

std::string last_system_message() {
    return system_message(static_cast<int>(GetLastError()));
}

}  // namespace tactus
