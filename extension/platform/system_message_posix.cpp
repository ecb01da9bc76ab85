#include <cstring>

#include "platform/system_message.hpp"

namespace tactus {

std::string system_message(int code) {
    return std::strerror(code);
}

}  // namespace tactus
