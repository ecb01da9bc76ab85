#include "platform/file.hpp"

#include <filesystem>

namespace tactus {

void make_folder_of(const std::string& path) {
    const std::filesystem::path file(std::u8string(path.begin(), path.end()));
    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);
}

}  // namespace tactus
