#include "platform/thread.hpp"

namespace tactus {

std::string Thread::start(const char* name, void (*run)(void*), void* context) {
    name_ = name;
    run_ = run;
    context_ = context;
    const std::string refused = create();
    running_ = refused.empty();
    return refused;
}

void Thread::leave() {
    if (running_) {
        let_run();
        running_ = false;
    }
}

void Thread::join() {
    if (running_) {
        wait_for_end();
        running_ = false;
    }
}

}  // namespace tactus
