// A socket at the very place of another one that is connected: it gets what others send there.
#pragma once

#include "platform/udp_socket.hpp"

namespace tactus {

// no_socket where the system has no such thing. With room for a few datagrams; the rest is dropped.
SocketHandle open_beside(SocketHandle connected, IpFamily family);

// Bytes of the oldest that waits, and where it came from; nothing: none does.
std::size_t receive_udp_from(SocketHandle socket, std::span<std::byte> into, IpAddress& from);
SocketError send_udp_to(SocketHandle socket, std::span<const std::byte> datagram, const IpAddress& to);

}  // namespace tactus
