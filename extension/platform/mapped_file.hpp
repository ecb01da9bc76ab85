// A file as memory, which is one and the same for all who have mapped it.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tactus {

class MappedFile {
public:
    MappedFile() = default;
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    // Both once, on one that is new; empty text, or why not.
    // Among the system's temporary files, of zeros, for this user alone; it goes from there with this.
    std::string create(const std::string& prefix, std::size_t bytes);
    // To be read. What others change shows; that the file becomes shorter they must not.
    std::string open(const std::string& path);

    std::span<std::byte> bytes() const { return bytes_; }
    const std::string& path() const { return path_; }

private:
    std::string map(int file, bool writes);

    std::string path_;
    std::span<std::byte> bytes_;
    bool is_own_ = false;
};

}  // namespace tactus
