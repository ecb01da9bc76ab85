#include "platform/side_socket.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>

#include "platform/socket_address.hpp"
#include "platform/socket_error_posix.hpp"

namespace tactus {

namespace {

constexpr int few_bytes = 4096;

void share_place(SocketHandle socket, int may) {
    setsockopt(static_cast<int>(socket), SOL_SOCKET, SO_REUSEADDR, &may, sizeof may);
}

}  // namespace

// The place is shared for as long as it takes to be bound, and with nobody after. Of two sockets at one place
// the system prefers the one that is connected to the sender.
SocketHandle open_beside(SocketHandle connected, IpFamily family) {
    SocketError error;
    const SocketHandle made = open_udp(family, error);
    if (made == no_socket) {
        return no_socket;
    }
    setsockopt(static_cast<int>(made), SOL_SOCKET, SO_RCVBUF, &few_bytes, sizeof few_bytes);
    share_place(connected, 1);
    share_place(made, 1);
    error = bind_udp(made, own_address(connected));
    share_place(connected, 0);
    share_place(made, 0);
    if (error) {
        close_udp(made);
        return no_socket;
    }
    return made;
}

std::size_t receive_udp_from(SocketHandle socket, std::span<std::byte> into, IpAddress& from) {
    SystemAddress address;
    const ssize_t came = recvfrom(static_cast<int>(socket), into.data(), into.size(), MSG_DONTWAIT,
                                  address.get(), &address.size);
    if (came <= 0) {
        return 0;
    }
    from = from_system(address.get());
    return static_cast<std::size_t>(came);
}

SocketError send_udp_to(SocketHandle socket, std::span<const std::byte> datagram, const IpAddress& to) {
    const SystemAddress address(to);
    const ssize_t sent = sendto(static_cast<int>(socket), datagram.data(), datagram.size(), MSG_DONTWAIT,
                                address.get(), address.size);
    return sent >= 0 ? SocketError{} : posix::socket_error(errno);
}

}  // namespace tactus
