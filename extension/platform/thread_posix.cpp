#include <pthread.h>

#include <bit>

#include "platform/system_message.hpp"
#include "platform/thread.hpp"

namespace tactus {

static_assert(sizeof(pthread_t) == sizeof(std::uintptr_t));

struct Thread::Entry {
    static void* enter(void* thread) {
        static_cast<Thread*>(thread)->begin();
        return nullptr;
    }
};

std::string Thread::create() {
    pthread_t made{};
    const int error = pthread_create(&made, nullptr, &Entry::enter, this);
    system_thread_ = std::bit_cast<std::uintptr_t>(made);
    return error == 0 ? std::string() : system_message(error);
}

void Thread::wait_for_end() {
    pthread_join(std::bit_cast<pthread_t>(system_thread_), nullptr);
}

void Thread::let_run() {
    pthread_detach(std::bit_cast<pthread_t>(system_thread_));
}

}  // namespace tactus
