#pragma once

#include <string>

namespace tactus {

// What the system says of one of its error codes, in UTF-8.
std::string system_message(int code);

// The same of the last call into the system that failed on this thread.
std::string last_system_message();

}  // namespace tactus
