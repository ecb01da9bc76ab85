// From addresses as people write them to sockets that talk to the far side and to nobody else.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/udp_socket.hpp"

namespace tactus {

struct UdpAddress {
    std::string host;  // a number ("10.0.0.2", "::1", "[::1]") or a name; empty: any, of this machine
    std::uint16_t port = 0;
};

// Bound here and connected there, so that the system drops what comes from anywhere else and says when nobody
// listens. A name may stand for several addresses of a family: which of them answers is found by trying.
struct UdpSocket {
    SocketHandle handle = no_socket;
    IpFamily family = IpFamily::any;
    std::vector<IpAddress> remotes;  // not empty
    std::size_t remote = 0;          // the one it is connected to
};

struct UdpSockets {
    std::vector<UdpSocket> sockets;  // one of each family of the far side's addresses; empty: see `error`
    std::uint16_t local_port = 0;
    std::string error;  // what is wrong and what to do
};

// Off the loop: may ask the network for a name. `loopback_only`: within this machine, refuses any other.
UdpSockets open_udp_sockets(const UdpAddress& local, const UdpAddress& remote, bool loopback_only);

// Connects to the next of its addresses.
void try_next_remote(UdpSocket& socket);

// What IP and UDP add to a datagram (unit: bytes).
std::size_t udp_overhead(IpFamily family);

}  // namespace tactus
