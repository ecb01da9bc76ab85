#include "platform/thread_slot.hpp"

namespace tactus {

namespace {

// The initial-exec model gives every thread its slot when it is created; the usual model of a shared library
// would allocate it at the first tick.
[[gnu::tls_model("initial-exec")]] thread_local void* slot = nullptr;

}  // namespace

void* thread_slot() {
    return slot;
}

void set_thread_slot(void* value) {
    slot = value;
}

}  // namespace tactus
