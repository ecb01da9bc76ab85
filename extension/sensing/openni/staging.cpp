#include "sensing/openni/staging.hpp"

#include <cstdlib>
#include <random>
#include <string>
#include <system_error>

#include "platform/shared_library.hpp"

namespace tactus {

namespace fs = std::filesystem;

namespace {

constexpr const char* library_name = "libOpenNI2.so.0";
constexpr const char* drivers = "OpenNI2/Drivers";

// The folder of a driver may hold what is not one.
bool is_driver(const fs::path& file) {
    const std::string name = file.filename().string();
    // A device that shows a ramp to all who ask for any camera, and a player that any file whose name is
    // asked for as a camera's ends, if it is damaged: see sensing/recording/.
    return name.starts_with("lib") && name.find(".so") != std::string::npos &&
           !name.starts_with("libDummyDevice") && !name.starts_with("libOniFile");
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

// It must not stay loaded: a library keeps the path that it was loaded by.
fs::path found_by_loader() {
    const std::string file = file_of_library(library_name);
    return file.empty() ? file_of_library("libOpenNI2.so") : file;
}

fs::path new_folder_name() {
    std::random_device random;
    return fs::temp_directory_path() /
           ("tactus_openni_" + std::to_string(random()) + std::to_string(random()));
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

Stage::Stage(const fs::path& library, const fs::path& own_driver) : folder_(name()) {
    if (!fs::create_directory(folder_)) {
        throw fs::filesystem_error("another program has it", folder_,
                                   std::make_error_code(std::errc::file_exists));
    }
    fs::permissions(folder_, fs::perms::owner_all);
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

const fs::path& Stage::name() {
    static const fs::path folder = new_folder_name();
    return folder;
}

Stage::~Stage() {
    std::error_code error;
    fs::remove_all(folder_, error);
}

fs::path Stage::library() const {
    return folder_ / library_name;
}

}  // namespace tactus
