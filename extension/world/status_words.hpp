// What a loop reports as bits, in words.
#pragma once

#include <string>

#include "realtime/tick_status.hpp"

namespace tactus {

// All that is set, one after the other; bits that nobody knows say nothing.
std::string status_words(TickStatus status);

}  // namespace tactus
