#include "network/key_source.hpp"

#include <cstdlib>

#include "network/shared_secret.hpp"
#include "platform/private_file.hpp"

namespace tactus {
namespace {

constexpr std::size_t max_key_bytes = 4096;

KeySource checked(const std::string& text, const std::string& where) {
    if (!shared_secret(text)) {
        return {{}, where + " holds no key: it takes 64 hexadecimal digits or at least 8 characters"};
    }
    return {text, {}};
}

KeySource read_file(const std::string& path) {
    const std::string where = "the key file \"" + path + "\"";
    const PrivateFile file = read_private_file(path, max_key_bytes);
    switch (file.trouble) {
        case FileTrouble::none:
            return checked(file.bytes, where);
        case FileTrouble::unreadable:
            return {{}, where + " cannot be read: " + file.system_text};
        case FileTrouble::not_ordinary:
            return {{}, where + " is no ordinary file"};
        case FileTrouble::open_to_others:
            return {{}, where + " is open to others on this machine: " + file.way_out};
        case FileTrouble::too_long:
            break;
    }
    return {{}, where + " is longer than any key"};
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
