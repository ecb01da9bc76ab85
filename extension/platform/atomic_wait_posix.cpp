#include "platform/atomic_wait.hpp"

#include <cstdint>

namespace tactus {

template <class Value>
void wait_while(const std::atomic<Value>& value, std::type_identity_t<Value> old) {
    value.wait(old, std::memory_order_acquire);
}

template <class Value>
void wake_all(std::atomic<Value>& value) {
    value.notify_all();
}

template void wait_while(const std::atomic<bool>&, bool);
template void wait_while(const std::atomic<std::int64_t>&, std::int64_t);
template void wake_all(std::atomic<bool>&);
template void wake_all(std::atomic<std::int64_t>&);

}  // namespace tactus
