#pragma once

#include <filesystem>

namespace tactus::testing {

// Lets this user alone read and write a file, or everybody read it. False: the system refuses.
bool set_access(const std::filesystem::path& file, bool open_to_others);

}  // namespace tactus::testing
