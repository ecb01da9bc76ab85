#include "sensing/recording/images_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace tactus {

namespace {

namespace fs = std::filesystem;

constexpr int most_names = 10'000;

std::string numbered(const std::string& path, int number) {
    const fs::path whole(path);
    const std::string name =
        whole.stem().string() + "_" + std::to_string(number) + whole.extension().string();
    return number == 1 ? path : (whole.parent_path() / name).string();
}

// Creates it, if there is none.
bool make_file(const std::string& path) {
    std::FILE* const file = std::fopen(path.c_str(), "wbx");
    return file != nullptr && std::fclose(file) == 0;
}

}  // namespace

std::string make_images_file(std::string& path) {
    const std::string wanted = path;
    for (int number = 1; number <= most_names; ++number) {
        path = numbered(wanted, number);
        if (make_file(path)) {
            return "";
        }
        if (errno != EEXIST) {
            break;
        }
    }
    return images_file_error(path, std::strerror(errno));
}

std::string images_file_error(const std::string& path, const std::string& why) {
    return "its images cannot be recorded into '" + path + "' (" + why + "): name another file, or none";
}

bool has_less_free(const std::string& path, std::uintmax_t bytes) {
    std::error_code error;
    const fs::space_info space = fs::space(path, error);
    return !error && space.available < bytes;
}

}  // namespace tactus
