// Files by their paths in UTF-8, as Godot's are, whatever the system's own letters.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace tactus {

// fopen().
std::FILE* open_file(const std::string& path, const char* mode);

struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, FileCloser>;

// The folder that it lies in, and those above, where they are missing. Opening the file says whether it
// worked.
void make_folder_of(const std::string& path);

}  // namespace tactus
