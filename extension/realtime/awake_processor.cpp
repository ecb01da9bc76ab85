#include "realtime/awake_processor.hpp"

#include <sched.h>

#include <cstring>
#include <fstream>

#include "realtime/sleeper.hpp"

namespace tactus {

namespace {

std::string first_line(const char* path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

// Idle priority on one processor, or nothing: at any other priority this thread would be in the way.
bool become_idle_on(int cpu) {
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(static_cast<std::size_t>(cpu), &only);
    const sched_param parameters{0};
    return pthread_setschedparam(pthread_self(), SCHED_IDLE, &parameters) == 0 &&
           pthread_setaffinity_np(pthread_self(), sizeof(only), &only) == 0;
}

}  // namespace

// "max 100000" or "200000 100000": allowance and period in microseconds.
bool limits_processor_time(const std::string& cpu_max) {
    return !cpu_max.empty() && cpu_max.rfind("max", 0) != 0;
}

std::string AwakeProcessor::start(int cpu) {
    stop();
    if (cpu < 0 || cpu >= CPU_SETSIZE) {
        return "the thread is not bound to one processor";
    }
    if (limits_processor_time(first_line("/sys/fs/cgroup/cpu.max"))) {
        return "this process's processor time is limited";
    }
    cpu_ = cpu;
    stop_requested_.store(false, std::memory_order_relaxed);
    const int error = pthread_create(&thread_, nullptr, &AwakeProcessor::run, this);
    if (error != 0) {
        return std::strerror(error);
    }
    running_ = true;
    return {};
}

void AwakeProcessor::stop() {
    if (running_) {
        stop_requested_.store(true, std::memory_order_relaxed);
        pthread_join(thread_, nullptr);
        running_ = false;
    }
}

void* AwakeProcessor::run(void* self) {
    const AwakeProcessor& awake = *static_cast<AwakeProcessor*>(self);
    pthread_setname_np(pthread_self(), "tactus-awake");
    if (!become_idle_on(awake.cpu_)) {
        return nullptr;
    }
    while (!awake.stop_requested_.load(std::memory_order_relaxed)) {
        relax_processor();
    }
    return nullptr;
}

}  // namespace tactus
