#include <sys/socket.h>

#include <cerrno>

#include "platform/receive_datagram_other.hpp"
#include "platform/socket_error_posix.hpp"

namespace tactus {

SocketError receive_datagram(SocketHandle socket, std::span<std::byte> into, std::size_t& size) {
    const ssize_t came = recv(static_cast<int>(socket), into.data(), into.size(), 0);
    size = static_cast<std::size_t>(came < 0 ? 0 : came);
    return came < 0 ? posix::socket_error(errno) : SocketError{};
}

}  // namespace tactus
