#include <dlfcn.h>
#include <link.h>

#include "platform/shared_library.hpp"

namespace tactus {

std::string file_of_library(const std::string& library) {
    void* const loaded = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (loaded == nullptr) {
        return "";
    }
    link_map* map = nullptr;
    const std::string file = dlinfo(loaded, RTLD_DI_LINKMAP, &map) == 0 ? map->l_name : "";
    dlclose(loaded);
    return file;
}

}  // namespace tactus
