// A thread of the system with a name, for loops that must know whether theirs was granted.
//
// Threads: start(), join() and the destructor belong to one owner.
#pragma once

#include <cstdint>
#include <string>

#include "platform/this_thread.hpp"

namespace tactus {

class Thread {
public:
    Thread() = default;
    ~Thread() { join(); }
    Thread(const Thread&) = delete;
    Thread& operator=(const Thread&) = delete;

    // Calls run(context) there. Empty text, or why there is no thread. `name` outlives the thread. Not while
    // one is running.
    std::string start(const char* name, void (*run)(void*), void* context);

    // Waits for its end. Without effect where there is none.
    void join();
    // It goes on by itself. This object has to live until it has begun to run.
    void leave();

private:
    struct Entry;  // by which the system calls begin()

    // Empty text, or why there is no thread.
    std::string create();
    void wait_for_end();
    void let_run();
    void begin() {
        name_this_thread(name_);
        run_(context_);
    }

    const char* name_ = nullptr;
    void (*run_)(void*) = nullptr;
    void* context_ = nullptr;
    std::uintptr_t system_thread_ = 0;
    bool running_ = false;
};

}  // namespace tactus
