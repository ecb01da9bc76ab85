#include <fcntl.h>
#include <sys/select.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "platform/system_message.hpp"
#include "platform/udp_socket.hpp"

namespace tactus {

struct SocketWait::System {
    int ends[2] = {-1, -1};  // a pipe: what is written stays, so that no later wait waits
};

SocketWait::SocketWait() : system_(std::make_unique<System>()) {
    if (pipe(system_->ends) != 0) {
        error_ = last_system_message();
        return;
    }
    for (const int end : system_->ends) {
        fcntl(end, F_SETFD, FD_CLOEXEC);
        fcntl(end, F_SETFL, O_NONBLOCK);
    }
}

SocketWait::~SocketWait() {
    for (const int end : system_->ends) {
        if (end >= 0) {
            close(end);
        }
    }
}

// pselect: poll() of this system knows no time below a millisecond.
void SocketWait::wait(std::span<const SocketHandle> sockets, Nanoseconds at_most) {
    const timespec timeout{static_cast<time_t>(at_most / nanoseconds_per_second),
                           static_cast<long>(at_most % nanoseconds_per_second)};
    fd_set files;
    FD_ZERO(&files);
    FD_SET(system_->ends[0], &files);
    int last = system_->ends[0];
    for (const SocketHandle socket : sockets.first(std::min(sockets.size(), max_sockets))) {
        FD_SET(static_cast<int>(socket), &files);
        last = std::max(last, static_cast<int>(socket));
    }
    pselect(last + 1, &files, nullptr, nullptr, &timeout, nullptr);
}

void SocketWait::wake() {
    const char one = 1;
    [[maybe_unused]] const ssize_t written = write(system_->ends[1], &one, sizeof one);
}

}  // namespace tactus
