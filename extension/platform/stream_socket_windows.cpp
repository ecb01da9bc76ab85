#include <winsock2.h>

#include "platform/stream_socket.hpp"
#include "platform/system_message.hpp"

namespace tactus {

namespace {

// (unit: milliseconds)
constexpr int send_time = 100;
constexpr int connect_time = 50;

int winsock() {
    static const int failed = [] {
        WSADATA data;
        return WSAStartup(MAKEWORD(2, 2), &data);
    }();
    return failed;
}

bool ready(SOCKET handle, short events, int milliseconds) {
    WSAPOLLFD file{handle, events, 0};
    return WSAPoll(&file, 1, milliseconds) > 0;
}

// 0, or the error. Where nothing listens, Windows asks three times within two seconds before it says so; a
// service of this machine that does not answer at once is too busy to be waited for.
int connect_soon(SOCKET handle, const sockaddr_in& address) {
    if (connect(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        return 0;
    }
    if (const int error = WSAGetLastError(); error != WSAEWOULDBLOCK) {
        return error;
    }
    if (!ready(handle, POLLWRNORM, connect_time)) {
        return WSAETIMEDOUT;
    }
    int error = 0;
    int size = sizeof error;
    getsockopt(handle, SOL_SOCKET, SO_ERROR, reinterpret_cast<char*>(&error), &size);
    return error;
}

}  // namespace

std::string StreamSocket::connect_here(std::uint16_t port) {
    close();
    if (const int failed = winsock(); failed != 0) {
        return system_message(failed);
    }
    const SOCKET made = socket(AF_INET, SOCK_STREAM, 0);
    if (made == INVALID_SOCKET) {
        return system_message(WSAGetLastError());
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    u_long without_waiting = 1;
    ioctlsocket(made, FIONBIO, &without_waiting);
    if (const int error = connect_soon(made, address); error != 0) {
        closesocket(made);
        return system_message(error);
    }
    const char on = 1;
    setsockopt(made, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    handle_ = static_cast<std::int64_t>(made);
    return {};
}

std::string StreamSocket::connect_to(const std::string&) {
    close();
    return "Windows has no such service";
}

void StreamSocket::close() {
    if (handle_ != closed) {
        closesocket(static_cast<SOCKET>(handle_));
        handle_ = closed;
    }
}

void StreamSocket::wait(Nanoseconds at_most) const {
    ready(static_cast<SOCKET>(handle_), POLLRDNORM, static_cast<int>(at_most / 1'000'000));
}

StreamSocket::Received StreamSocket::receive(std::span<std::uint8_t> into, Nanoseconds at_most) {
    const auto handle = static_cast<SOCKET>(handle_);
    if (!ready(handle, POLLRDNORM, static_cast<int>(at_most / 1'000'000))) {
        return {State::nothing, 0};
    }
    const int got = recv(handle, reinterpret_cast<char*>(into.data()), static_cast<int>(into.size()), 0);
    if (got > 0) {
        return {State::done, static_cast<std::size_t>(got)};
    }
    return {got < 0 && WSAGetLastError() == WSAEWOULDBLOCK ? State::nothing : State::gone, 0};
}

StreamSocket::State StreamSocket::send(std::span<const std::uint8_t> bytes) {
    const auto handle = static_cast<SOCKET>(handle_);
    while (!bytes.empty()) {
        const int sent =
            ::send(handle, reinterpret_cast<const char*>(bytes.data()), static_cast<int>(bytes.size()), 0);
        if (sent > 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
        } else if (sent == 0 || WSAGetLastError() != WSAEWOULDBLOCK ||
                   !ready(handle, POLLWRNORM, send_time)) {
            return State::gone;
        }
    }
    return State::done;
}

}  // namespace tactus
