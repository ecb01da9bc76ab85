// Windows's own functions take UTF-16.
#pragma once

#include <string>

namespace tactus::windows {

std::wstring to_wide(const std::string& utf8);
std::string to_utf8(const std::wstring& wide);

}  // namespace tactus::windows
