#include "world/sensing_library.hpp"

#include <algorithm>

#include "platform/file.hpp"
#include "platform/shared_library.hpp"

namespace tactus {

namespace {

constexpr std::size_t max_found_cameras = 16;

// It lies beside this one and is called like it: libtactus.linux… and libtactus_sensing.linux….
std::string path_of_eyes() {
    std::string path = path_of_this_library(reinterpret_cast<const void*>(&path_of_eyes));
    const std::size_t name = path.find_last_of("/\\") + 1;  // 0 where there is no folder
    constexpr const char* own = "libtactus.";
    if (path.compare(name, std::char_traits<char>::length(own), own) != 0) {
        return "";
    }
    return path.insert(name + std::char_traits<char>::length(own) - 1, "_sensing");
}

bool is_there(const std::string& path) {
    std::FILE* const file = path.empty() ? nullptr : open_file(path, "rb");
    if (file != nullptr) {
        std::fclose(file);
    }
    return file != nullptr;
}

}  // namespace

const DepthSensing* depth_sensing(std::string& error) {
    using Entry = const DepthSensing* (*)(int version);
    static const DepthSensing* found = nullptr;
    if (found != nullptr) {
        return found;
    }
    const std::string path = path_of_eyes();
    if (!is_there(path)) {
        error =
            "this Tactus was built without depth cameras: on Linux, ./run setup --with-sensing builds it "
            "with "
            "them";
        return nullptr;
    }
    const auto entry = reinterpret_cast<Entry>(function_of_library(path, depth_sensing_entry, error));
    if (entry == nullptr) {
        error = "the depth cameras' library cannot be loaded: " + error;
        return nullptr;
    }
    found = entry(depth_sensing_version);
    error = found != nullptr ? "" : path + " is of another version: build both anew";
    return found;
}

std::vector<FoundCamera> found_cameras(std::string& error) {
    const DepthSensing* const sensing = depth_sensing(error);
    if (sensing == nullptr) {
        return {};
    }
    std::vector<FoundCamera> found(max_found_cameras);
    std::array<char, 512> why{};
    const int count = sensing->scan(found, why);
    error = count < 0 ? why.data() : "";
    found.resize(static_cast<std::size_t>(std::clamp(count, 0, static_cast<int>(found.size()))));
    return found;
}

}  // namespace tactus
