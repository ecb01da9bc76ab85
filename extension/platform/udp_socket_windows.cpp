#include "platform/udp_socket.hpp"

#include <winsock2.h>
#include <ws2tcpip.h>

#include "platform/socket_address.hpp"
#include "platform/socket_error_windows.hpp"
#include "platform/system_message.hpp"

namespace tactus {

namespace {

// Loaded with the first use and never given back: worlds come and go.
void start_sockets() {
    [[maybe_unused]] static const int code = [] {
        WSADATA data;
        return WSAStartup(MAKEWORD(2, 2), &data);
    }();
}

SocketError last_error() {
    return windows::socket_error(WSAGetLastError());
}

SOCKET to_system(SocketHandle socket) {
    return static_cast<SOCKET>(socket);
}

void set(SOCKET socket, int level, int option, int value) {
    setsockopt(socket, level, option, reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

SocketError windows::socket_error(int code) {
    switch (code) {
        case WSAEWOULDBLOCK:
        case WSAENOBUFS:
        case WSAEINTR:
            return {SocketTrouble::not_now, code};
        case WSAECONNRESET:  // nobody listens there, in answer to an earlier datagram
        case WSAECONNREFUSED:
        case WSAENETRESET:
        case WSAEHOSTUNREACH:
        case WSAENETUNREACH:
        case WSAENETDOWN:
            return {SocketTrouble::unreachable, code};
        case WSAEADDRINUSE:
            return {SocketTrouble::in_use, code};
        case WSAEACCES:
            return {SocketTrouble::reserved, code};
        case WSAEADDRNOTAVAIL:
            return {SocketTrouble::not_here, code};
        default:
            return {SocketTrouble::other, code};
    }
}

std::vector<IpAddress> find_addresses(const std::string& host, std::uint16_t port, IpFamily family,
                                      std::string& error) {
    start_sockets();
    const addrinfo hints = lookup_hints(family);
    addrinfo* found = nullptr;
    const int code =
        getaddrinfo(host.empty() ? nullptr : host.c_str(), std::to_string(port).c_str(), &hints, &found);
    if (code != 0) {
        error = system_message(code);
        return {};
    }
    return from_system_list(found);
}

// The port is this socket's alone: without being asked, Windows lets another program share it.
SocketHandle open_udp(IpFamily family, SocketError& error) {
    start_sockets();
    const SOCKET made = WSASocketW(to_system(family), SOCK_DGRAM, IPPROTO_UDP, nullptr, 0,
                                   WSA_FLAG_OVERLAPPED | WSA_FLAG_NO_HANDLE_INHERIT);
    if (made == INVALID_SOCKET) {
        error = last_error();
        return no_socket;
    }
    u_long not_blocking = 1;
    ioctlsocket(made, FIONBIO, &not_blocking);
    set(made, SOL_SOCKET, SO_EXCLUSIVEADDRUSE, 1);
    set(made, SOL_SOCKET, SO_RCVBUF, system_buffer_bytes);
    set(made, SOL_SOCKET, SO_SNDBUF, system_buffer_bytes);
    if (family == IpFamily::six) {
        set(made, IPPROTO_IPV6, IPV6_V6ONLY, 1);
    }
    return static_cast<SocketHandle>(made);
}

SocketError bind_udp(SocketHandle socket, const IpAddress& address) {
    const SystemAddress at(address);
    return bind(to_system(socket), at.get(), at.size) == 0 ? SocketError{} : last_error();
}

SocketError connect_udp(SocketHandle socket, const IpAddress& address) {
    const SystemAddress to(address);
    return connect(to_system(socket), to.get(), to.size) == 0 ? SocketError{} : last_error();
}

IpAddress own_address(SocketHandle socket) {
    SystemAddress address;
    getsockname(to_system(socket), address.get(), &address.size);
    return from_system(address.get());
}

IpAddress far_address(SocketHandle socket) {
    SystemAddress address;
    getpeername(to_system(socket), address.get(), &address.size);
    return from_system(address.get());
}

SocketError send_udp(SocketHandle socket, std::span<const std::byte> datagram) {
    const int sent = send(to_system(socket), reinterpret_cast<const char*>(datagram.data()),
                          static_cast<int>(datagram.size()), 0);
    return sent >= 0 ? SocketError{} : last_error();
}

void close_udp(SocketHandle socket) {
    closesocket(to_system(socket));
}

}  // namespace tactus
