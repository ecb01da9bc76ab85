#include "played/played_stall.hpp"

#include <dlfcn.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstdarg>
#include <filesystem>
#include <fstream>

namespace tactus::shared {

namespace {

volatile sig_atomic_t stall_us = 0;
thread_local volatile sig_atomic_t calls_under_way = 0;
thread_local volatile sig_atomic_t is_to_stall = 0;

void stand_still() {
    is_to_stall = 0;
    const timespec span{stall_us / 1'000'000, stall_us % 1'000'000 * 1'000};
    nanosleep(&span, nullptr);
}

void on_signal(int) {
    if (calls_under_way != 0) {
        is_to_stall = 1;
    } else {
        stand_still();
    }
}

pid_t thread_named(const std::string& name) {
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
        std::string found;
        std::getline(std::ifstream(entry.path() / "comm"), found);
        if (found == name) {
            return static_cast<pid_t>(std::stol(entry.path().filename()));
        }
    }
    return 0;
}

}  // namespace

void stall_thread(const std::string& name, Nanoseconds span) {
    stall_us = static_cast<int>(span / 1'000);
    struct sigaction action{};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGUSR1, &action, nullptr);
    syscall(SYS_tgkill, getpid(), thread_named(name), SIGUSR1);
}

}  // namespace tactus::shared

// In front of umockdev's, which is in front of the C library's; exported from the program.
extern "C" __attribute__((visibility("default"))) int ioctl(int descriptor, unsigned long request, ...) {
    using namespace tactus::shared;
    using Call = int (*)(int, unsigned long, ...);
    static const Call next = reinterpret_cast<Call>(dlsym(RTLD_NEXT, "ioctl"));
    std::va_list arguments;
    va_start(arguments, request);
    void* const argument = va_arg(arguments, void*);
    va_end(arguments);
    calls_under_way = 1;
    const int result = next(descriptor, request, argument);
    calls_under_way = 0;
    if (is_to_stall != 0) {
        stand_still();
    }
    return result;
}
