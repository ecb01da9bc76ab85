#include "played/played_stall.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>

namespace tactus::shared {

namespace {

std::atomic<bool> is_stalled{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // so it may be looked at within a signal

void stand_still(int) {
    while (is_stalled.load(std::memory_order_acquire)) {
        const timespec span{0, 100'000};
        nanosleep(&span, nullptr);
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

StalledThread::StalledThread(const std::string& name) {
    struct sigaction action{};
    action.sa_handler = stand_still;
    action.sa_flags = SA_RESTART;
    sigaction(SIGUSR1, &action, nullptr);
    const pid_t thread = thread_named(name);
    is_stalled.store(true, std::memory_order_release);
    since_ = monotonic_now();
    syscall(SYS_tgkill, getpid(), thread, SIGUSR1);
}

StalledThread::~StalledThread() {
    is_stalled.store(false, std::memory_order_release);
}

}  // namespace tactus::shared
