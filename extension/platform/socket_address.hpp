// Addresses as the system's calls take them.
#pragma once

#if defined(_WIN32)
#include <winsock2.h>
#include <ws2tcpip.h>
#else
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#endif

#include <cstring>

#include "platform/udp_socket.hpp"

namespace tactus {

inline int to_system(IpFamily family) {
    return family == IpFamily::six ? AF_INET6 : family == IpFamily::four ? AF_INET : AF_UNSPEC;
}

struct SystemAddress {
    SystemAddress() = default;

    explicit SystemAddress(const IpAddress& address) {
        if (address.family == IpFamily::six) {
            sockaddr_in6 six{};
            six.sin6_family = AF_INET6;
            six.sin6_port = htons(address.port);
            six.sin6_scope_id = address.zone;
            std::memcpy(&six.sin6_addr, address.host.data(), sizeof six.sin6_addr);
            std::memcpy(&storage, &six, sizeof six);
            size = sizeof six;
        } else {
            sockaddr_in four{};
            four.sin_family = AF_INET;
            four.sin_port = htons(address.port);
            std::memcpy(&four.sin_addr, address.host.data(), sizeof four.sin_addr);
            std::memcpy(&storage, &four, sizeof four);
            size = sizeof four;
        }
    }

    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
    sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }

    sockaddr_storage storage{};
    socklen_t size = sizeof(sockaddr_storage);
};

// Of a family that is neither: no address.
inline IpAddress from_system(const sockaddr* given) {
    IpAddress address;
    if (given->sa_family == AF_INET6) {
        sockaddr_in6 six;
        std::memcpy(&six, given, sizeof six);
        address.family = IpFamily::six;
        address.port = ntohs(six.sin6_port);
        address.zone = static_cast<std::uint32_t>(six.sin6_scope_id);
        std::memcpy(address.host.data(), &six.sin6_addr, sizeof six.sin6_addr);
    } else if (given->sa_family == AF_INET) {
        sockaddr_in four;
        std::memcpy(&four, given, sizeof four);
        address.family = IpFamily::four;
        address.port = ntohs(four.sin_port);
        std::memcpy(address.host.data(), &four.sin_addr, sizeof four.sin_addr);
    }
    return address;
}

// What getaddrinfo() found, which is given back.
inline std::vector<IpAddress> from_system_list(addrinfo* found) {
    std::vector<IpAddress> all;
    for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
        if (one->ai_family == AF_INET || one->ai_family == AF_INET6) {
            all.push_back(from_system(one->ai_addr));
        }
    }
    freeaddrinfo(found);
    return all;
}

inline addrinfo lookup_hints(IpFamily family) {
    addrinfo hints{};
    hints.ai_family = to_system(family);
    hints.ai_socktype = SOCK_DGRAM;
    hints.ai_flags = AI_NUMERICSERV | AI_PASSIVE;  // passive: counts only where no host is named
    return hints;
}

// Room in the system for a few hundred datagrams while the thread is not let onto a processor.
inline constexpr int system_buffer_bytes = 1 << 20;

}  // namespace tactus
