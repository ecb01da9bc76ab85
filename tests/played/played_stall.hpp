// A thread that hangs, wherever it is: a driver's, in the kernel or in its library.
#pragma once

#include <string>

#include "platform/clock.hpp"

namespace tactus::shared {

// The thread of this process that is named so stands still for that long, from now on. umockdev plays all
// calls of a node one after the other, where the kernel would hold up nobody else: a thread that is within
// one hangs as soon as that is over.
void stall_thread(const std::string& name, Nanoseconds span);

}  // namespace tactus::shared
