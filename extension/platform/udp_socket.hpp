// UDP sockets of the system. None of these functions waits for the network, but for find_addresses(); no
// child process inherits a socket.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

enum class IpFamily : std::uint8_t { any, four, six };

struct IpAddress {
    IpFamily family = IpFamily::any;      // any: no address
    std::array<std::uint8_t, 16> host{};  // in the network's order; IPv4 has four
    std::uint32_t zone = 0;               // IPv6: the interface of an address that each of them may have
    std::uint16_t port = 0;

    bool operator==(const IpAddress&) const = default;
};

bool is_loopback(const IpAddress& address);
IpAddress loopback(IpFamily family, std::uint16_t port);  // four or six

// Those that a number or a name stands for, and where `host` is empty those to listen on. May ask the
// network. Empty: `error` says why.
std::vector<IpAddress> find_addresses(const std::string& host, std::uint16_t port, IpFamily family,
                                      std::string& error);

enum class SocketTrouble : std::uint8_t {
    none,
    not_now,      // nothing waits, or there is no room
    unreachable,  // the far machine, or the way to it, says so
    in_use,       // the port
    reserved,     // the port, for the system
    not_here,     // the address is not one of this machine
    other,
};

struct SocketError {
    SocketTrouble trouble = SocketTrouble::none;
    int code = 0;  // the system's, for system_message()

    explicit operator bool() const { return trouble != SocketTrouble::none; }
};

using SocketHandle = std::intptr_t;
inline constexpr SocketHandle no_socket = -1;

SocketHandle open_udp(IpFamily family, SocketError& error);  // four or six
SocketError bind_udp(SocketHandle socket, const IpAddress& address);
// From then on the system drops what comes from anywhere else, and says when nobody listens.
SocketError connect_udp(SocketHandle socket, const IpAddress& address);
IpAddress own_address(SocketHandle socket);
IpAddress far_address(SocketHandle socket);  // of one that is connected
SocketError send_udp(SocketHandle socket, std::span<const std::byte> datagram);
void close_udp(SocketHandle socket);

// Datagrams taken from the system together, where it can: with one call.
class DatagramBatch {
public:
    static constexpr std::size_t capacity = 64;

    // One that is longer than `longest` comes as its first `longest` + 1 bytes.
    explicit DatagramBatch(std::size_t longest);
    ~DatagramBatch();
    DatagramBatch(const DatagramBatch&) = delete;
    DatagramBatch& operator=(const DatagramBatch&) = delete;

    // What waits, at most `capacity`. In trouble there is nothing.
    SocketError receive(SocketHandle socket);
    std::size_t size() const { return size_; }
    std::span<const std::byte> operator[](std::size_t i) const;

private:
    struct System;
    std::unique_ptr<System> system_;
    std::size_t size_ = 0;
};

// Threads: wait() belongs to one, wake() may be called by anybody.
class SocketWait {
public:
    static constexpr std::size_t max_sockets = 2;

    SocketWait();
    ~SocketWait();
    SocketWait(const SocketWait&) = delete;
    SocketWait& operator=(const SocketWait&) = delete;

    // Empty, or why it cannot wait.
    const std::string& error() const { return error_; }

    // Until something has come for one of at most max_sockets, or somebody wakes it, or the time is over.
    void wait(std::span<const SocketHandle> sockets, Nanoseconds at_most);

    // For good: no later wait() waits.
    void wake();

private:
    struct System;
    std::unique_ptr<System> system_;
    std::string error_;
};

}  // namespace tactus
