#include "platform/wide_text_windows.hpp"

#include <windows.h>

namespace tactus::windows {

std::wstring to_wide(const std::string& utf8) {
    const int given = static_cast<int>(utf8.size());
    std::wstring wide(
        static_cast<std::size_t>(MultiByteToWideChar(CP_UTF8, 0, utf8.data(), given, nullptr, 0)), L'\0');
    MultiByteToWideChar(CP_UTF8, 0, utf8.data(), given, wide.data(), static_cast<int>(wide.size()));
    return wide;
}

std::string to_utf8(const std::wstring& wide) {
    const int given = static_cast<int>(wide.size());
    std::string utf8(static_cast<std::size_t>(
                         WideCharToMultiByte(CP_UTF8, 0, wide.data(), given, nullptr, 0, nullptr, nullptr)),
                     '\0');
    WideCharToMultiByte(CP_UTF8, 0, wide.data(), given, utf8.data(), static_cast<int>(utf8.size()), nullptr,
                        nullptr);
    return utf8;
}

}  // namespace tactus::windows
