#pragma once

#include <string>

namespace tactus {

// What the system says of one of its error codes, in UTF-8.
std::string system_message(int code);

}  // namespace tactus
