#include "played/played_poll.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace tactus::shared {

namespace {

constexpr Nanoseconds never = std::numeric_limits<Nanoseconds>::max();
constexpr std::size_t max_descriptors = 16;

std::atomic<bool> used{false};

// What is open there. umockdev's readlink() would wait for the ioctl() of another thread, which may wait for
// who polls here: the kernel is asked itself.
std::string path_of(int descriptor) {
    std::array<char, 512> path{};
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    const long length = syscall(SYS_readlink, link.c_str(), path.data(), path.size());
    return {path.data(), static_cast<std::size_t>(std::max(0L, length))};
}

timespec span_until(Nanoseconds time) {
    const Nanoseconds left = std::max<Nanoseconds>(0, time - monotonic_now());
    return {static_cast<time_t>(left / 1'000'000'000), static_cast<long>(left % 1'000'000'000)};
}

}  // namespace

struct PlayedPolls {
    std::mutex mutex;
    std::vector<PlayedPoll*> all;

    static PlayedPolls& one() {
        static PlayedPolls polls;
        return polls;
    }

    // When the first of the played nodes among them is ready. Each gives way to its event in what is slept
    // on.
    Nanoseconds ready_at(std::span<const pollfd> given, std::span<const std::string> paths,
                         std::span<pollfd> slept_on, unsigned& played) {
        const std::lock_guard lock(mutex);
        Nanoseconds first = never;
        for (std::size_t i = 0; i < given.size(); ++i) {
            slept_on[i] = given[i];
            slept_on[i].revents = 0;
            for (PlayedPoll* const poll : all) {
                // umockdev puts its nodes below a folder of its own.
                if (paths[i].ends_with(poll->node)) {
                    slept_on[i] = {poll->wake_, POLLIN, 0};
                    played |= 1u << i;
                    first = std::min(first, poll->ready_at());
                }
            }
        }
        return first;
    }

    static int wait(std::span<pollfd> given, std::span<const std::string> paths, Nanoseconds end) {
        std::array<pollfd, max_descriptors> slept_on{};
        for (;;) {
            unsigned played = 0;
            const Nanoseconds ready =
                one().ready_at(given, paths, std::span(slept_on).first(given.size()), played);
            if (played != 0) {
                used.store(true, std::memory_order_relaxed);
            }
            const bool is_ready = ready != never && ready <= monotonic_now();
            const Nanoseconds until = is_ready ? 0 : std::min(ready, end);
            const timespec span = span_until(until == never ? 0 : until);
            const int found = ppoll(slept_on.data(), given.size(), until == never ? nullptr : &span, nullptr);
            if (found < 0) {
                return found;
            }
            int count = 0;
            for (std::size_t i = 0; i < given.size(); ++i) {
                const bool plays = (played >> i & 1u) != 0;
                if (plays && slept_on[i].revents != 0) {
                    eventfd_t told = 0;
                    eventfd_read(slept_on[i].fd, &told);
                }
                given[i].revents = static_cast<short>(plays ? (is_ready ? POLLOUT : 0) : slept_on[i].revents);
                count += given[i].revents != 0 ? 1 : 0;
            }
            if (count > 0 || monotonic_now() >= end) {
                return count;
            }
        }
    }
};

PlayedPoll::PlayedPoll(std::string given)
    : node(std::move(given)), wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    PlayedPolls& polls = PlayedPolls::one();
    const std::lock_guard lock(polls.mutex);
    polls.all.push_back(this);
}

PlayedPoll::~PlayedPoll() {
    PlayedPolls& polls = PlayedPolls::one();
    {
        const std::lock_guard lock(polls.mutex);
        std::erase(polls.all, this);
    }
    close(wake_);
}

void PlayedPoll::changed() {
    eventfd_write(wake_, 1);
}

bool PlayedPoll::is_used() {
    return used.load(std::memory_order_relaxed);
}

}  // namespace tactus::shared

// In front of the C library's, also for libraries that are loaded later: it is exported from the program. Who
// plays a device polls, too, with the device's lock in hand: only who polls a node comes past a lock.
extern "C" __attribute__((visibility("default"))) int poll(pollfd* descriptors, nfds_t count, int timeout) {
    using namespace tactus;
    const Nanoseconds end = timeout < 0 ? shared::never : monotonic_now() + Nanoseconds{timeout} * 1'000'000;
    const std::span<pollfd> given(descriptors, count);
    std::array<std::string, shared::max_descriptors> paths;
    bool is_node = false;
    for (std::size_t i = 0; i < count && count <= paths.size(); ++i) {
        paths[i] = (given[i].events & POLLOUT) != 0 ? shared::path_of(given[i].fd) : "";
        is_node = is_node || paths[i].find("/dev/bus/usb/") != std::string::npos;
    }
    if (!is_node) {
        const timespec span = shared::span_until(timeout < 0 ? 0 : end);
        return ppoll(descriptors, count, timeout < 0 ? nullptr : &span, nullptr);
    }
    return shared::PlayedPolls::wait(given, paths, end);
}
