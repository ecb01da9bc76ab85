#pragma once

#include <cstdio>
#include <filesystem>

namespace tactus {

// fopen(), whatever letters the path has.
std::FILE* open_file(const std::filesystem::path& path, const char* mode);

}  // namespace tactus
