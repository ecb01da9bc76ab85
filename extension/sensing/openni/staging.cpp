#include "sensing/openni/staging.hpp"

#include <dlfcn.h>
#include <link.h>

#include <cstdlib>

namespace tactus {

namespace fs = std::filesystem;

namespace {

constexpr const char* library_name = "libOpenNI2.so.0";
constexpr const char* drivers = "OpenNI2/Drivers";

// The folder of a driver may hold what is not one.
bool is_driver(const fs::path& file) {
    const std::string name = file.filename().string();
    // A device that shows a ramp to everybody who asks for any camera.
    return name.starts_with("lib") && name.find(".so") != std::string::npos &&
           !name.starts_with("libDummyDevice");
}

// OpenNI2 takes files that end so for drivers.
std::string name_of_driver(const fs::path& file) {
    const std::string name = file.filename().string();
    return name.substr(0, name.find(".so")) + ".so.0";
}

fs::path named_by(const char* variable) {
    const char* const folder = std::getenv(variable);
    if (folder == nullptr) {
        return {};
    }
    for (const char* name : {library_name, "libOpenNI2.so"}) {
        if (fs::exists(fs::path(folder) / name)) {
            return fs::path(folder) / name;
        }
    }
    return {};
}

// As the system's loader finds it. It does not stay: a library that is loaded keeps its first path.
fs::path found_by_loader() {
    for (const char* name : {library_name, "libOpenNI2.so"}) {
        void* const loaded = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
        if (loaded == nullptr) {
            continue;
        }
        link_map* map = nullptr;
        fs::path path;
        if (dlinfo(loaded, RTLD_DI_LINKMAP, &map) == 0) {
            path = map->l_name;
        }
        dlclose(loaded);
        return path;
    }
    return {};
}

}  // namespace

fs::path find_openni() {
    for (const fs::path& path :
         {named_by("OPENNI2_REDIST64"), named_by("OPENNI2_REDIST"), found_by_loader()}) {
        if (!path.empty()) {
            return fs::canonical(path);
        }
    }
    return {};
}

Stage::Stage(const fs::path& folder, const fs::path& library, const fs::path& own_driver) : folder_(folder) {
    fs::create_symlink(library, folder_ / library_name);
    fs::create_directories(folder_ / drivers);
    const fs::path of_system = library.parent_path() / drivers;
    if (fs::is_directory(of_system)) {
        for (const fs::directory_entry& entry : fs::directory_iterator(of_system)) {
            if (is_driver(entry.path())) {
                const fs::path link = folder_ / drivers / name_of_driver(entry.path());
                std::error_code taken;  // by another version of the same
                fs::create_symlink(entry.path(), link, taken);
            }
        }
    }
    if (!own_driver.empty() && fs::exists(own_driver)) {
        fs::create_symlink(fs::canonical(own_driver), folder_ / drivers / name_of_driver(own_driver));
    }
}

Stage::~Stage() {
    std::error_code error;
    fs::remove_all(folder_, error);
}

fs::path Stage::library() const {
    return folder_ / library_name;
}

}  // namespace tactus
