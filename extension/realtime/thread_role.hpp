// Who may call what, as an assert. A thread acts in the haptic role while it holds a HapticRole: the tick
// loop's own thread for its whole life, a test or a stepped world for the length of one tick. In release
// builds the assert is empty.
#pragma once

#include <cassert>

namespace tactus {

class HapticRole {
public:
    HapticRole() { ++depth_; }
    ~HapticRole() { --depth_; }
    HapticRole(const HapticRole&) = delete;
    HapticRole& operator=(const HapticRole&) = delete;

    static bool held() { return depth_ > 0; }

private:
    static inline thread_local int depth_ = 0;
};

}  // namespace tactus

// First line of what only the haptic thread may call.
#define TACTUS_ASSERT_HAPTIC_THREAD() \
    assert(::tactus::HapticRole::held() && "only the haptic thread may call this")

// First line of what allocates, locks or waits, and so must never be called from within a tick.
#define TACTUS_ASSERT_NOT_HAPTIC_THREAD() \
    assert(!::tactus::HapticRole::held() && "the haptic thread may not call this")
