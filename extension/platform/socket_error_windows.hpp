#pragma once

#include "platform/udp_socket.hpp"

namespace tactus::windows {

// What an error code of Winsock means.
SocketError socket_error(int code);

}  // namespace tactus::windows
