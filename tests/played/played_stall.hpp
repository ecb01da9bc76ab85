// A thread that hangs, wherever it is: a driver's, in the kernel or in its library.
#pragma once

#include <string>

#include "platform/clock.hpp"

namespace tactus::shared {

// The thread of this process that is named so stands still for that long, wherever it is just now; in a call
// of the kernel that does not sleep, at its end. When it was told so (on the steady clock).
Nanoseconds stall_thread(const std::string& name, Nanoseconds span);

}  // namespace tactus::shared
