#pragma once

#include <filesystem>
#include <string>

namespace tactus {

// A function of a library, which is loaded and stays so. Null: `error` says why.
void* function_of_library(const std::filesystem::path& library, const char* name, std::string& error);

}  // namespace tactus
