#include "played/played_stall.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

namespace tactus::shared {

namespace {

volatile sig_atomic_t stall_us = 0;

void stand_still(int) {
    const timespec span{stall_us / 1'000'000, stall_us % 1'000'000 * 1'000};
    nanosleep(&span, nullptr);
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

Nanoseconds stall_thread(const std::string& name, Nanoseconds span) {
    stall_us = static_cast<int>(span / 1'000);
    struct sigaction action{};
    action.sa_handler = stand_still;
    action.sa_flags = SA_RESTART;
    sigaction(SIGUSR1, &action, nullptr);
    const pid_t thread = thread_named(name);
    const Nanoseconds now = monotonic_now();
    syscall(SYS_tgkill, getpid(), thread, SIGUSR1);
    return now;
}

}  // namespace tactus::shared
