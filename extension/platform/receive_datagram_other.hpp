#pragma once

#include "platform/udp_socket.hpp"

namespace tactus {

// The one that waits first, cut where it is longer than `into`; `size`: of what is there then. For systems
// that give them one at a time.
SocketError receive_datagram(SocketHandle socket, std::span<std::byte> into, std::size_t& size);

}  // namespace tactus
