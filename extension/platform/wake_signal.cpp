#include "platform/wake_signal.hpp"

namespace tactus {

// The fence pairs with the store in wait_until(): either the waiting thread sees what was changed, or this
// one sees that it waits.
void WakeSignal::wake() {
    std::atomic_thread_fence(std::memory_order_seq_cst);
    if (waits_.load(std::memory_order_relaxed)) {
        signal();
    }
}

}  // namespace tactus
