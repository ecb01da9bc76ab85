#include "platform/udp_socket.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "platform/socket_address.hpp"
#include "platform/socket_error_posix.hpp"

namespace tactus {

namespace {

SocketError last_error() {
    return posix::socket_error(errno);
}

}  // namespace

SocketError posix::socket_error(int code) {
    switch (code) {
        case EAGAIN:
        case ENOBUFS:
        case EINTR:
            return {SocketTrouble::not_now, code};
        case ECONNREFUSED:
        case EHOSTUNREACH:
        case ENETUNREACH:
        case ENETDOWN:
            return {SocketTrouble::unreachable, code};
        case EADDRINUSE:
            return {SocketTrouble::in_use, code};
        case EACCES:
            return {SocketTrouble::reserved, code};
        case EADDRNOTAVAIL:
            return {SocketTrouble::not_here, code};
        default:
            return {SocketTrouble::other, code};
    }
}

std::vector<IpAddress> find_addresses(const std::string& host, std::uint16_t port, IpFamily family,
                                      std::string& error) {
    const addrinfo hints = lookup_hints(family);
    addrinfo* found = nullptr;
    const int code =
        getaddrinfo(host.empty() ? nullptr : host.c_str(), std::to_string(port).c_str(), &hints, &found);
    if (code != 0) {
        error = gai_strerror(code);
        return {};
    }
    return from_system_list(found);
}

SocketHandle open_udp(IpFamily family, SocketError& error) {
    const int made = socket(to_system(family), SOCK_DGRAM, 0);
    if (made < 0) {
        error = last_error();
        return no_socket;
    }
    fcntl(made, F_SETFD, FD_CLOEXEC);
    fcntl(made, F_SETFL, O_NONBLOCK);
    setsockopt(made, SOL_SOCKET, SO_RCVBUF, &system_buffer_bytes, sizeof system_buffer_bytes);
    setsockopt(made, SOL_SOCKET, SO_SNDBUF, &system_buffer_bytes, sizeof system_buffer_bytes);
    if (family == IpFamily::six) {
        const int only = 1;
        setsockopt(made, IPPROTO_IPV6, IPV6_V6ONLY, &only, sizeof only);
    }
    return made;
}

SocketError bind_udp(SocketHandle socket, const IpAddress& address) {
    const SystemAddress at(address);
    return bind(static_cast<int>(socket), at.get(), at.size) == 0 ? SocketError{} : last_error();
}

SocketError connect_udp(SocketHandle socket, const IpAddress& address) {
    const SystemAddress to(address);
    return connect(static_cast<int>(socket), to.get(), to.size) == 0 ? SocketError{} : last_error();
}

IpAddress own_address(SocketHandle socket) {
    SystemAddress address;
    getsockname(static_cast<int>(socket), address.get(), &address.size);
    return from_system(address.get());
}

IpAddress far_address(SocketHandle socket) {
    SystemAddress address;
    getpeername(static_cast<int>(socket), address.get(), &address.size);
    return from_system(address.get());
}

SocketError send_udp(SocketHandle socket, std::span<const std::byte> datagram) {
    const ssize_t sent = send(static_cast<int>(socket), datagram.data(), datagram.size(), 0);
    return sent >= 0 ? SocketError{} : last_error();
}

void close_udp(SocketHandle socket) {
    close(static_cast<int>(socket));
}

}  // namespace tactus
