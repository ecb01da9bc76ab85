#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "platform/mapped_file.hpp"
#include "platform/system_message.hpp"

namespace tactus {

namespace {

const char* temporary_folder() {
    const char* const named = std::getenv("TMPDIR");
    return named != nullptr && *named != '\0' ? named : "/tmp";
}

}  // namespace

std::string MappedFile::create(const std::string& prefix, std::size_t bytes) {
    path_ = std::string(temporary_folder()) + "/" + prefix + "XXXXXX";
    const int file = mkostemp(path_.data(), O_CLOEXEC);
    if (file < 0) {
        return path_ + ": " + last_system_message();
    }
    is_own_ = true;
    if (ftruncate(file, static_cast<off_t>(bytes)) != 0) {
        const std::string why = path_ + ": " + last_system_message();
        close(file);
        return why;
    }
    return map(file, true);
}

std::string MappedFile::open(const std::string& path) {
    path_ = path;
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    return file < 0 ? last_system_message() : map(file, false);
}

std::string MappedFile::map(int file, bool writes) {
    struct stat status{};
    void* mapped = MAP_FAILED;
    int error = 0;
    if (fstat(file, &status) != 0) {
        error = errno;
    } else if (status.st_size > 0) {
        mapped = mmap(nullptr, static_cast<std::size_t>(status.st_size),
                      writes ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, file, 0);
        error = errno;
    }
    close(file);
    if (mapped == MAP_FAILED) {
        return error != 0 ? system_message(error) : "it is empty";
    }
    bytes_ = {static_cast<std::byte*>(mapped), static_cast<std::size_t>(status.st_size)};
    return "";
}

MappedFile::~MappedFile() {
    if (!bytes_.empty()) {
        munmap(bytes_.data(), bytes_.size());
    }
    if (is_own_) {
        unlink(path_.c_str());
    }
}

}  // namespace tactus
