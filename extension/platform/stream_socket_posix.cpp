#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "platform/stream_socket.hpp"
#include "platform/system_message.hpp"

namespace tactus {

namespace {

// (unit: milliseconds)
constexpr int send_time = 100;
constexpr int connect_time = 50;

#ifdef MSG_NOSIGNAL
constexpr int send_flags = MSG_NOSIGNAL;
#else
constexpr int send_flags = 0;
#endif

void make_ours(int handle) {
    fcntl(handle, F_SETFL, O_NONBLOCK);
    fcntl(handle, F_SETFD, FD_CLOEXEC);
}

bool ready(int handle, short events, int milliseconds) {
    pollfd file{handle, events, 0};
    return poll(&file, 1, milliseconds) > 0;
}

// 0, or the error. The kernel answers at once for a service that listens; one whose queue is full is too busy
// to be waited for.
int connect_soon(int handle, const sockaddr_in& address) {
    if (connect(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        return 0;
    }
    if (errno != EINPROGRESS) {
        return errno;
    }
    if (!ready(handle, POLLOUT, connect_time)) {
        return ETIMEDOUT;
    }
    int error = 0;
    socklen_t size = sizeof error;
    getsockopt(handle, SOL_SOCKET, SO_ERROR, &error, &size);
    return error;
}

}  // namespace

std::string StreamSocket::connect_here(std::uint16_t port) {
    close();
    const int made = socket(AF_INET, SOCK_STREAM, 0);
    if (made < 0) {
        return last_system_message();
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    make_ours(made);
    if (const int error = connect_soon(made, address); error != 0) {
        ::close(made);
        return system_message(error);
    }
    const int on = 1;
    setsockopt(made, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    handle_ = made;
    return {};
}

// A service that is too busy to be waited for is none.
std::string StreamSocket::connect_to(const std::string& path) {
    close();
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) {
        return system_message(ENAMETOOLONG);
    }
    std::memcpy(address.sun_path, path.data(), path.size());
    const int made = socket(AF_UNIX, SOCK_STREAM, 0);
    if (made < 0) {
        return last_system_message();
    }
    make_ours(made);
    if (connect(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        const std::string why = last_system_message();
        ::close(made);
        return why;
    }
    handle_ = made;
    return {};
}

void StreamSocket::close() {
    if (handle_ != closed) {
        ::close(static_cast<int>(handle_));
        handle_ = closed;
    }
}

void StreamSocket::wait(Nanoseconds at_most) const {
    ready(static_cast<int>(handle_), POLLIN, static_cast<int>(at_most / 1'000'000));
}

StreamSocket::Received StreamSocket::receive(std::span<std::uint8_t> into, Nanoseconds at_most) {
    const int handle = static_cast<int>(handle_);
    const ssize_t got = ready(handle, POLLIN, static_cast<int>(at_most / 1'000'000))
                            ? recv(handle, into.data(), into.size(), 0)
                            : -2;
    if (got > 0) {
        return {State::done, static_cast<std::size_t>(got)};
    }
    return {got == -2 || (got < 0 && (errno == EAGAIN || errno == EINTR)) ? State::nothing : State::gone, 0};
}

StreamSocket::State StreamSocket::send(std::span<const std::uint8_t> bytes) {
    const int handle = static_cast<int>(handle_);
    while (!bytes.empty()) {
        const ssize_t sent = ::send(handle, bytes.data(), bytes.size(), send_flags);
        if (sent > 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
        } else if (sent == 0 || (errno != EAGAIN && errno != EINTR) || !ready(handle, POLLOUT, send_time)) {
            return State::gone;
        }
    }
    return State::done;
}

}  // namespace tactus
