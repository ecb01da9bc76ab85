#include <cerrno>
#include <cstring>

#include "platform/system_message.hpp"

namespace tactus {

std::string system_message(int code) {
    return std::strerror(code);
}

std::string last_system_message() {
    return system_message(errno);
}

}  // namespace tactus
