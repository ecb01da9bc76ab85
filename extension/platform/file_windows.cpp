#include <cwchar>

#include "platform/file.hpp"
#include "platform/wide_text_windows.hpp"

namespace tactus {

std::FILE* open_file(const std::string& path, const char* mode) {
    return _wfopen(windows::to_wide(path).c_str(), windows::to_wide(mode).c_str());
}

}  // namespace tactus
