#include "played/played_node.hpp"

#include <dlfcn.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tactus::shared {

namespace {

constexpr Nanoseconds never = std::numeric_limits<Nanoseconds>::max();
constexpr std::size_t max_descriptors = 16;

// What is open there. umockdev's readlink() would wait for the ioctl() of another thread, which may wait for
// who polls here: the kernel is asked itself.
std::string path_of(int descriptor) {
    std::array<char, 512> path{};
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    const long length = syscall(SYS_readlink, link.c_str(), path.data(), path.size());
    return {path.data(), static_cast<std::size_t>(std::max(0L, length))};
}

// umockdev puts its nodes below a folder of its own.
bool is_played(const std::string& path) {
    return !path.starts_with("/dev/") && path.find("/dev/bus/usb/") != std::string::npos;
}

// ppoll() itself is played below.
int kernel_poll(std::span<pollfd> files, nfds_t count, const timespec* span, const sigset_t* mask) {
    timespec left = span != nullptr ? *span : timespec{};
    return static_cast<int>(syscall(SYS_ppoll, files.data(), count, span != nullptr ? &left : nullptr, mask,
                                    mask != nullptr ? _NSIG / 8 : 0));
}

timespec span_until(Nanoseconds time) {
    const Nanoseconds left = std::max<Nanoseconds>(0, time - monotonic_now());
    return {static_cast<time_t>(left / 1'000'000'000), static_cast<long>(left % 1'000'000'000)};
}

class WithoutSignals {
public:
    WithoutSignals() {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~WithoutSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    WithoutSignals(const WithoutSignals&) = delete;
    WithoutSignals& operator=(const WithoutSignals&) = delete;

    const sigset_t& before() const { return before_; }

private:
    sigset_t before_;
};

}  // namespace

struct PlayedNodes {
    std::mutex mutex;
    std::vector<PlayedNode*> all;

    static PlayedNodes& one() {
        static PlayedNodes nodes;
        return nodes;
    }

    PlayedNode* at(const std::string& path) const {
        const auto found = std::find_if(all.begin(), all.end(),
                                        [&path](const PlayedNode* one) { return path.ends_with(one->node); });
        return found != all.end() ? *found : nullptr;
    }

    // One that has vanished is a device that was pulled out.
    int call(const std::string& path, unsigned long request, void* argument) {
        const std::lock_guard lock(mutex);
        PlayedNode* const node = at(path);
        return node != nullptr ? node->call(request, argument) : -ENODEV;
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
            if (PlayedNode* const node = is_played(paths[i]) ? at(paths[i]) : nullptr) {
                slept_on[i] = {node->wake_, POLLIN, 0};
                played |= 1u << i;
                first = std::min(first, node->ready_at());
            }
        }
        return first;
    }

    static int wait(std::span<pollfd> given, std::span<const std::string> paths, Nanoseconds end) {
        const WithoutSignals outside_of_sleep;
        std::array<pollfd, max_descriptors> slept_on{};
        for (;;) {
            unsigned played = 0;
            const Nanoseconds ready =
                one().ready_at(given, paths, std::span(slept_on).first(given.size()), played);
            const bool is_ready = ready != never && ready <= monotonic_now();
            const Nanoseconds until = is_ready ? 0 : std::min(ready, end);
            const timespec span = span_until(until == never ? 0 : until);
            const int found = kernel_poll(slept_on, given.size(), until == never ? nullptr : &span,
                                          &outside_of_sleep.before());
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

PlayedNode::PlayedNode(std::string given)
    : node(std::move(given)), wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    PlayedNodes& nodes = PlayedNodes::one();
    const std::lock_guard lock(nodes.mutex);
    nodes.all.push_back(this);
}

void PlayedNode::vanish() {
    PlayedNodes& nodes = PlayedNodes::one();
    {
        const std::lock_guard lock(nodes.mutex);
        std::erase(nodes.all, this);
    }
    close(wake_);
}

void PlayedNode::changed() {
    eventfd_write(wake_, 1);
}

}  // namespace tactus::shared

// In front of the C library's and umockdev's, also for libraries that are loaded later: they are exported
// from the program. Who plays a device polls, too, with the device's lock in hand: only who polls a node
// comes past a lock.
#define IN_FRONT extern "C" __attribute__((visibility("default")))

IN_FRONT int ppoll(pollfd* descriptors, nfds_t count, const timespec* timeout, const sigset_t* mask) {
    using namespace tactus;
    const Nanoseconds end =
        timeout == nullptr
            ? shared::never
            : monotonic_now() + Nanoseconds{timeout->tv_sec} * 1'000'000'000 + timeout->tv_nsec;
    const std::span<pollfd> given(descriptors, count);
    std::array<std::string, shared::max_descriptors> paths;
    bool is_node = false;
    for (std::size_t i = 0; i < count && count <= paths.size(); ++i) {
        paths[i] = (given[i].events & POLLOUT) != 0 ? shared::path_of(given[i].fd) : "";
        is_node = is_node || shared::is_played(paths[i]);
    }
    if (!is_node) {
        return shared::kernel_poll(given, count, timeout, mask);
    }
    return shared::PlayedNodes::wait(given, paths, end);
}

IN_FRONT int poll(pollfd* descriptors, nfds_t count, int timeout) {
    const timespec span{timeout / 1'000, timeout % 1'000 * 1'000'000L};
    return ppoll(descriptors, count, timeout < 0 ? nullptr : &span, nullptr);
}

IN_FRONT int ioctl(int descriptor, unsigned long request, ...) {
    using namespace tactus;
    std::va_list more;
    va_start(more, request);
    void* const argument = va_arg(more, void*);
    va_end(more);
    const std::string path = shared::path_of(descriptor);
    if (!shared::is_played(path)) {
        using Ioctl = int (*)(int, unsigned long, void*);
        static const auto next = reinterpret_cast<Ioctl>(dlsym(RTLD_NEXT, "ioctl"));
        return next(descriptor, request, argument);
    }
    int result = 0;
    {
        const shared::WithoutSignals in_the_kernel;
        result = shared::PlayedNodes::one().call(path, request, argument);
    }
    if (result < 0) {
        errno = -result;
        return -1;
    }
    return result;
}
