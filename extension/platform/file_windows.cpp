#include <cwchar>

#include "platform/file.hpp"
#include "platform/wide_text_windows.hpp"

namespace tactus {

std::FILE* open_file(const std::filesystem::path& path, const char* mode) {
    return _wfopen(path.c_str(), windows::to_wide(mode).c_str());
}

}  // namespace tactus
