#include "network/udp_sockets.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

namespace tactus {
namespace {

// Room in the system for a few hundred datagrams while the thread is not let onto a processor.
constexpr int system_buffer_bytes = 1 << 20;

// "[::1]" is how an address with colons is written before a port.
std::string without_brackets(const std::string& host) {
    const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
    return bracketed ? host.substr(1, host.size() - 2) : host;
}

socklen_t size_of(const sockaddr_storage& address) {
    return address.ss_family == AF_INET6 ? sizeof(sockaddr_in6) : sizeof(sockaddr_in);
}

std::vector<sockaddr_storage> resolve(const UdpAddress& address, int family, int flags, std::string& error) {
    addrinfo hints{};
    hints.ai_family = family;
    hints.ai_socktype = SOCK_DGRAM;
    hints.ai_flags = AI_NUMERICSERV | flags;
    addrinfo* found = nullptr;
    const std::string host = without_brackets(address.host);
    const int code = getaddrinfo(host.empty() ? nullptr : host.c_str(), std::to_string(address.port).c_str(),
                                 &hints, &found);
    if (code != 0) {
        error = "the address \"" + address.host + "\" is not known: " + gai_strerror(code);
        return {};
    }
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
    std::vector<sockaddr_storage> all;
    for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
        if (one->ai_family == AF_INET || one->ai_family == AF_INET6) {
            std::memcpy(&all.emplace_back(), one->ai_addr, one->ai_addrlen);
        }
    }
    return all;
}

bool is_loopback(const sockaddr_storage& address) {
    if (address.ss_family == AF_INET6) {
        const in6_addr& host = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
        return IN6_IS_ADDR_LOOPBACK(&host);
    }
    return ntohl(reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr) >> 24 == IN_LOOPBACKNET;
}

sockaddr_storage loopback(int family, std::uint16_t port) {
    sockaddr_storage address{};
    if (family == AF_INET6) {
        auto& six = reinterpret_cast<sockaddr_in6&>(address);
        six.sin6_family = AF_INET6;
        six.sin6_addr = in6addr_loopback;
        six.sin6_port = htons(port);
    } else {
        auto& four = reinterpret_cast<sockaddr_in&>(address);
        four.sin_family = AF_INET;
        four.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        four.sin_port = htons(port);
    }
    return address;
}

std::string bind_error(const UdpAddress& local, int error) {
    const std::string place = "port " + std::to_string(local.port);
    if (error == EADDRINUSE) {
        return place + " is in use by another program: end that one or choose another port";
    }
    if (error == EACCES) {
        return place + " is reserved for the system: choose one from 1024 to 65535";
    }
    if (error == EADDRNOTAVAIL) {
        return "the local address \"" + local.host +
               "\" is not one of this machine: leave it empty to listen on all of its addresses";
    }
    return place + " cannot be used: " + std::strerror(error);
}

sockaddr_storage name_of(int file, bool peer) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    const auto ask = peer ? getpeername : getsockname;
    [[maybe_unused]] const int code = ask(file, reinterpret_cast<sockaddr*>(&address), &size);
    return address;
}

std::uint16_t port_of(const sockaddr_storage& address) {
    return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                                               : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

bool same_place(const sockaddr_storage& a, const sockaddr_storage& b) {
    if (a.ss_family != b.ss_family || port_of(a) != port_of(b)) {
        return false;
    }
    if (a.ss_family == AF_INET6) {
        return std::memcmp(&reinterpret_cast<const sockaddr_in6&>(a).sin6_addr,
                           &reinterpret_cast<const sockaddr_in6&>(b).sin6_addr, sizeof(in6_addr)) == 0;
    }
    return reinterpret_cast<const sockaddr_in&>(a).sin_addr.s_addr ==
           reinterpret_cast<const sockaddr_in&>(b).sin_addr.s_addr;
}

bool connect_to(int file, const sockaddr_storage& remote) {
    return connect(file, reinterpret_cast<const sockaddr*>(&remote), size_of(remote)) == 0;
}

void set_up(int file, int family) {
    setsockopt(file, SOL_SOCKET, SO_RCVBUF, &system_buffer_bytes, sizeof system_buffer_bytes);
    setsockopt(file, SOL_SOCKET, SO_SNDBUF, &system_buffer_bytes, sizeof system_buffer_bytes);
    if (family == AF_INET6) {
        const int only = 1;
        setsockopt(file, IPPROTO_IPV6, IPV6_V6ONLY, &only, sizeof only);
    }
}

std::string own_address_error(const UdpAddress& remote) {
    return "\"" + remote.host + "\" with port " + std::to_string(remote.port) +
           " is this side's own address: set the address and the port of the far side, and another port for "
           "this side where both run on one machine";
}

// -1 and `error` where it cannot be.
int open_socket(const UdpSocket& wanted, const UdpAddress& local, const UdpAddress& remote,
                bool loopback_only, std::string& error) {
    sockaddr_storage here{};
    if (local.host.empty() && loopback_only) {
        here = loopback(wanted.family, local.port);
    } else {
        const std::vector<sockaddr_storage> found = resolve(local, wanted.family, AI_PASSIVE, error);
        if (found.empty()) {
            return -1;
        }
        here = found.front();
    }
    const int made = socket(wanted.family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (made < 0) {
        error = std::string("the system gives no socket: ") + std::strerror(errno);
        return -1;
    }
    set_up(made, wanted.family);
    if (bind(made, reinterpret_cast<const sockaddr*>(&here), size_of(here)) != 0) {
        error = bind_error(local, errno);
    } else if (!std::ranges::any_of(wanted.remotes, [&](const auto& one) { return connect_to(made, one); })) {
        error = "there is no way to \"" + remote.host + "\": " + std::strerror(errno);
    } else if (same_place(name_of(made, false), name_of(made, true))) {
        error = own_address_error(remote);
    } else {
        return made;
    }
    ::close(made);
    return -1;
}

}  // namespace

UdpSockets open_udp_sockets(const UdpAddress& local, const UdpAddress& remote, bool loopback_only) {
    UdpSockets opened;
    if (remote.host.empty() || remote.port == 0) {
        opened.error = "the far side has no address: set its address and its port";
        return opened;
    }
    std::vector<sockaddr_storage> remotes = resolve(remote, AF_UNSPEC, 0, opened.error);
    if (remotes.empty()) {
        return opened;
    }
    if (loopback_only) {
        std::erase_if(remotes, [](const sockaddr_storage& address) { return !is_loopback(address); });
        if (remotes.empty()) {
            opened.error = "without a key this side talks within this machine only, and \"" + remote.host +
                           "\" is another one: give both sides the same key";
            return opened;
        }
    }
    UdpAddress bound = local;
    for (const int family : {AF_INET6, AF_INET}) {
        UdpSocket socket{-1, family, {}, 0};
        std::ranges::copy_if(
            remotes, std::back_inserter(socket.remotes),
            [family](const sockaddr_storage& address) { return address.ss_family == family; });
        if (socket.remotes.empty()) {
            continue;
        }
        socket.file = open_socket(socket, bound, remote, loopback_only, opened.error);
        if (socket.file >= 0) {
            opened.local_port = bound.port = port_of(name_of(socket.file, false));
            opened.sockets.push_back(std::move(socket));
        }
    }
    if (!opened.sockets.empty()) {
        opened.error.clear();
    }
    return opened;
}

void try_next_remote(UdpSocket& socket) {
    for (std::size_t tried = 0; tried < socket.remotes.size(); ++tried) {
        socket.remote = (socket.remote + 1) % socket.remotes.size();
        if (connect_to(socket.file, socket.remotes[socket.remote])) {
            return;
        }
    }
}

std::size_t udp_overhead(int family) {
    constexpr std::size_t of_udp = 8, of_ip4 = 20, of_ip6 = 40;
    return of_udp + (family == AF_INET6 ? of_ip6 : of_ip4);
}

}  // namespace tactus
