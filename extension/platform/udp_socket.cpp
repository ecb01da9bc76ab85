#include "platform/udp_socket.hpp"

#include <algorithm>

namespace tactus {

bool is_loopback(const IpAddress& address) {
    return address.family == IpFamily::four ? address.host[0] == 127
                                            : address.host == loopback(IpFamily::six, 0).host;
}

IpAddress loopback(IpFamily family, std::uint16_t port) {
    IpAddress address{family, {}, 0, port};
    if (family == IpFamily::six) {
        address.host.back() = 1;
    } else {
        std::ranges::copy(std::array<std::uint8_t, 4>{127, 0, 0, 1}, address.host.begin());
    }
    return address;
}

}  // namespace tactus
