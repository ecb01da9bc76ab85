#include <winsock2.h>

#include "platform/receive_datagram_other.hpp"
#include "platform/socket_error_windows.hpp"

namespace tactus {

// One that is longer than its room is an error here, of which the beginning has come.
SocketError receive_datagram(SocketHandle socket, std::span<std::byte> into, std::size_t& size) {
    const int came = recv(static_cast<SOCKET>(socket), reinterpret_cast<char*>(into.data()),
                          static_cast<int>(into.size()), 0);
    const int code = came < 0 ? WSAGetLastError() : 0;
    const bool cut = code == WSAEMSGSIZE;
    size = cut ? into.size() : static_cast<std::size_t>(came < 0 ? 0 : came);
    return code == 0 || cut ? SocketError{} : windows::socket_error(code);
}

}  // namespace tactus
