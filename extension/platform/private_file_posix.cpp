#include "platform/private_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "platform/system_message.hpp"

namespace tactus {

namespace {

// Closes itself.
struct File {
    explicit File(const std::string& path) : number(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
    ~File() {
        if (number >= 0) {
            close(number);
        }
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    int number;
};

PrivateFile refused(FileTrouble trouble, std::string system_text = {}, std::string way_out = {}) {
    return {trouble, {}, std::move(system_text), std::move(way_out)};
}

}  // namespace

PrivateFile read_private_file(const std::string& path, std::size_t max_bytes) {
    const File file(path);
    struct stat status{};
    if (file.number < 0 || fstat(file.number, &status) != 0) {
        return refused(FileTrouble::unreadable, last_system_message());
    }
    if (!S_ISREG(status.st_mode)) {
        return refused(FileTrouble::not_ordinary);
    }
    if ((status.st_mode & (S_IRGRP | S_IROTH | S_IWGRP | S_IWOTH)) != 0) {
        return refused(FileTrouble::open_to_others, {}, "chmod 600 \"" + path + "\"");
    }
    std::string bytes(max_bytes + 1, '\0');
    const ssize_t size = read(file.number, bytes.data(), bytes.size());
    if (size < 0) {
        return refused(FileTrouble::unreadable, last_system_message());
    }
    if (static_cast<std::size_t>(size) > max_bytes) {
        return refused(FileTrouble::too_long);
    }
    bytes.resize(static_cast<std::size_t>(size));
    return {FileTrouble::none, bytes, {}, {}};
}

}  // namespace tactus
