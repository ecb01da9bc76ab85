#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "platform/system_message.hpp"
#include "platform/udp_socket.hpp"

namespace tactus {

struct SocketWait::System {
    int event = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
};

SocketWait::SocketWait() : system_(std::make_unique<System>()) {
    if (system_->event < 0) {
        error_ = last_system_message();
    }
}

SocketWait::~SocketWait() {
    if (system_->event >= 0) {
        close(system_->event);
    }
}

void SocketWait::wait(std::span<const SocketHandle> sockets, Nanoseconds at_most) {
    const timespec timeout{static_cast<time_t>(at_most / nanoseconds_per_second),
                           static_cast<long>(at_most % nanoseconds_per_second)};
    std::array<pollfd, 1 + max_sockets> files{{{system_->event, POLLIN, 0}}};
    const std::size_t watched = std::min(sockets.size(), max_sockets);
    for (std::size_t i = 0; i < watched; ++i) {
        files[i + 1] = {static_cast<int>(sockets[i]), POLLIN, 0};
    }
    ppoll(files.data(), watched + 1, &timeout, nullptr);
}

void SocketWait::wake() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(system_->event, &one, sizeof one);
}

}  // namespace tactus
