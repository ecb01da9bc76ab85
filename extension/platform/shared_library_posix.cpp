#include <dlfcn.h>

#include "platform/shared_library.hpp"

namespace tactus {

void* function_of_library(const std::string& library, const char* name, std::string& error) {
    void* const loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const function = loaded != nullptr ? dlsym(loaded, name) : nullptr;
    if (function == nullptr) {
        error = dlerror();
    }
    return function;
}

std::string path_of_this_library(const void* inside) {
    Dl_info info{};
    return dladdr(inside, &info) != 0 && info.dli_fname != nullptr ? info.dli_fname : "";
}

// Of the program itself dlopen() finds no library, and need not.
void keep_this_library() {
    const std::string own = path_of_this_library(reinterpret_cast<const void*>(&keep_this_library));
    if (!own.empty()) {
        dlopen(own.c_str(), RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
    }
}

}  // namespace tactus
