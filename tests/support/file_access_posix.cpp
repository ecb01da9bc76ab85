#include <sys/stat.h>

#include "support/file_access.hpp"

namespace tactus::testing {

bool set_access(const std::filesystem::path& file, bool open_to_others) {
    return chmod(file.c_str(), open_to_others ? 0644 : 0600) == 0;
}

}  // namespace tactus::testing
