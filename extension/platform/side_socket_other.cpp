#include "platform/side_socket.hpp"

namespace tactus {

// Which of two sockets at one place gets a datagram is not defined.
SocketHandle open_beside(SocketHandle, IpFamily) {
    return no_socket;
}

std::size_t receive_udp_from(SocketHandle, std::span<std::byte>, IpAddress&) {
    return 0;
}

SocketError send_udp_to(SocketHandle, std::span<const std::byte>, const IpAddress&) {
    return {SocketTrouble::other, 0};
}

}  // namespace tactus
