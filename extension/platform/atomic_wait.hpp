// Waiting for an atomic value to change, as std::atomic's wait() and notify_all() do it. Where the system
// has no futex, those of libstdc++ (12) look at the value before they take the lock that the wake comes
// under, and a wake that falls in between is lost.
#pragma once

#include <atomic>
#include <type_traits>

namespace tactus {

// Returns once the value is another; it acquires. Value: bool or std::int64_t.
template <class Value>
void wait_while(const std::atomic<Value>& value, std::type_identity_t<Value> old);

// After a change: wakes all who wait. Without a lock: the haptic thread may do it.
template <class Value>
void wake_all(std::atomic<Value>& value);

}  // namespace tactus
