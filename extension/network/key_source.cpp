#include "network/key_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "network/shared_secret.hpp"

namespace tactus {
namespace {

constexpr std::size_t max_key_bytes = 4096;

KeySource checked(const std::string& text, const std::string& where) {
    if (!shared_secret(text)) {
        return {{}, where + " holds no key: it takes 64 hexadecimal digits or at least 8 characters"};
    }
    return {text, {}};
}

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

KeySource read_file(const std::string& path) {
    const std::string where = "the key file \"" + path + "\"";
    const File file(path);
    struct stat status{};
    if (file.number < 0 || fstat(file.number, &status) != 0) {
        return {{}, where + " cannot be read: " + std::strerror(errno)};
    }
    if (!S_ISREG(status.st_mode)) {
        return {{}, where + " is no ordinary file"};
    }
    if ((status.st_mode & (S_IRGRP | S_IROTH | S_IWGRP | S_IWOTH)) != 0) {
        return {{}, where + " is open to others on this machine: chmod 600 \"" + path + "\""};
    }
    std::array<char, max_key_bytes + 1> bytes;
    const ssize_t size = read(file.number, bytes.data(), bytes.size());
    if (size < 0 || static_cast<std::size_t>(size) > max_key_bytes) {
        return {{}, where + (size < 0 ? " cannot be read" : " is longer than any key")};
    }
    return checked(std::string(bytes.data(), static_cast<std::size_t>(size)), where);
}

}  // namespace

KeySource read_key(const std::string& file) {
    if (!file.empty()) {
        return read_file(file);
    }
    const char* const text = std::getenv(key_variable);
    if (text == nullptr || *text == '\0') {
        return {};
    }
    return checked(text, std::string("the environment's ") + key_variable);
}

}  // namespace tactus
