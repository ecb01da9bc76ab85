// A file that is written as long as something is recorded, by one recording of this process alone: two would
// write over each other.
//
// Threads: the thread that owns all recordings.
#pragma once

#include <cstdio>
#include <string>

#include "platform/file.hpp"

namespace tactus {

class WrittenFile {
public:
    WrittenFile() = default;  // of no file
    ~WrittenFile() { close(); }
    WrittenFile(const WrittenFile&) = delete;
    WrittenFile& operator=(const WrittenFile&) = delete;

    // Makes the folder, and the file empty. Returns an empty text, or why it cannot be written and what to
    // do: then there is no file.
    std::string open(const std::string& path);
    // Writes what the system still holds. Returns an empty text, or that the file is cut short.
    std::string close();

    // Null where there is no file.
    std::FILE* get() const { return file_.get(); }
    explicit operator bool() const { return file_ != nullptr; }
    // What is wrong where a write has failed.
    std::string cut_short() const;

private:
    OpenFile file_;
    std::string path_;
};

// Whether both paths name the same file, by whatever folders and links.
bool is_same_file(const std::string& path, const std::string& other);

}  // namespace tactus
