// A thread that hangs, wherever it is: a driver's, in its library or in ours.
#pragma once

#include <string>

#include "platform/clock.hpp"

namespace tactus::shared {

// The thread of this process that is named so stands still for as long as this lives, wherever it is just
// now; in a call of the kernel that does not sleep, at its end. One at a time.
class StalledThread {
public:
    explicit StalledThread(const std::string& name);
    ~StalledThread();
    StalledThread(const StalledThread&) = delete;
    StalledThread& operator=(const StalledThread&) = delete;

    // When it was told so (on the steady clock).
    Nanoseconds since() const { return since_; }

private:
    Nanoseconds since_ = 0;
};

}  // namespace tactus::shared
