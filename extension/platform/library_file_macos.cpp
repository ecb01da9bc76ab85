#include <dlfcn.h>
#include <mach-o/dyld.h>

#include <cstdint>

#include "platform/shared_library.hpp"

namespace tactus {

namespace {

bool is_image(const char* file, void* loaded) {
    void* const same = dlopen(file, RTLD_LAZY | RTLD_LOCAL | RTLD_NOLOAD);
    if (same != nullptr) {
        dlclose(same);
    }
    return same == loaded;
}

}  // namespace

// dlinfo() is not there: the file is the one among the loaded images that opens as the same handle.
std::string file_of_library(const std::string& library) {
    void* const loaded = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (loaded == nullptr) {
        return "";
    }
    std::string found;
    for (std::uint32_t image = _dyld_image_count(); image-- > 0 && found.empty();) {
        const char* const file = _dyld_get_image_name(image);
        if (file != nullptr && is_image(file, loaded)) {
            found = file;
        }
    }
    dlclose(loaded);
    return found;
}

}  // namespace tactus
