#include <windows.h>

#include <cstdint>

#include "platform/atomic_wait.hpp"

namespace tactus {

// The system compares once more under its own lock, and may wake without reason.
template <class Value>
void wait_while(const std::atomic<Value>& value, std::type_identity_t<Value> old) {
    static_assert(sizeof(value) == sizeof(old), "compared as bytes");
    void* const place = const_cast<std::atomic<Value>*>(&value);
    while (value.load(std::memory_order_acquire) == old) {
        WaitOnAddress(place, &old, sizeof(old), INFINITE);
    }
}

template <class Value>
void wake_all(std::atomic<Value>& value) {
    WakeByAddressAll(&value);
}

template void wait_while(const std::atomic<bool>&, bool);
template void wait_while(const std::atomic<std::int64_t>&, std::int64_t);
template void wake_all(std::atomic<bool>&);
template void wake_all(std::atomic<std::int64_t>&);

}  // namespace tactus
