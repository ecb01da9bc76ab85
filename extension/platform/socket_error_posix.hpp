#pragma once

#include "platform/udp_socket.hpp"

namespace tactus::posix {

// What an errno of a socket's call means.
SocketError socket_error(int code);

}  // namespace tactus::posix
