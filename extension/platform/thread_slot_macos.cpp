#include <pthread.h>

#include "platform/thread_slot.hpp"

namespace tactus {

namespace {

pthread_key_t make_slot_key() {
    pthread_key_t key{};
    pthread_key_create(&key, nullptr);
    return key;
}

// When the library is loaded: the first keys of a process have their room in every thread.
const pthread_key_t slot_key = make_slot_key();

}  // namespace

void* thread_slot() {
    return pthread_getspecific(slot_key);
}

void set_thread_slot(void* value) {
    pthread_setspecific(slot_key, value);
}

}  // namespace tactus
