#include "network/udp_sockets.hpp"

#include <algorithm>
#include <iterator>

#include "platform/system_message.hpp"

namespace tactus {
namespace {

// "[::1]" is how an address with colons is written before a port.
std::string without_brackets(const std::string& host) {
    const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
    return bracketed ? host.substr(1, host.size() - 2) : host;
}

std::vector<IpAddress> resolve(const UdpAddress& address, IpFamily family, std::string& error) {
    std::string why;
    std::vector<IpAddress> found = find_addresses(without_brackets(address.host), address.port, family, why);
    if (found.empty()) {
        error = "the address \"" + address.host + "\" is not known: " + why;
    }
    return found;
}

std::string bind_error(const UdpAddress& local, SocketError error) {
    const std::string place = "port " + std::to_string(local.port);
    switch (error.trouble) {
        case SocketTrouble::in_use:
            return place + " is in use by another program: end that one or choose another port";
        case SocketTrouble::reserved:
            return place + " is reserved for the system: choose one from 1024 to 65535";
        case SocketTrouble::not_here:
            return "the local address \"" + local.host +
                   "\" is not one of this machine: leave it empty to listen on all of its addresses";
        default:
            return place + " cannot be used: " + system_message(error.code);
    }
}

std::string own_address_error(const UdpAddress& remote) {
    return "\"" + remote.host + "\" with port " + std::to_string(remote.port) +
           " is this side's own address: set the address and the port of the other side, and another port "
           "for "
           "this side where both run on one machine";
}

std::string family_error(const UdpAddress& local, const UdpAddress& remote, IpFamily of_remote) {
    const bool remote_is_six = of_remote == IpFamily::six;
    return "the local address \"" + local.host + "\" belongs to " + (remote_is_six ? "IPv4" : "IPv6") +
           " and the other side's \"" + remote.host + "\" to " + (remote_is_six ? "IPv6" : "IPv4") +
           ": leave the local address empty, or give both of one kind";
}

// The other side of this machine may be set to 127.0.0.1: a lone ::1 stands for both.
void add_other_loopback(std::vector<IpAddress>& remotes) {
    if (remotes.size() == 1 && remotes[0].family == IpFamily::six && is_loopback(remotes[0])) {
        remotes.push_back(loopback(IpFamily::four, remotes[0].port));
    }
}

// Connects to the first of its addresses that there is a way to.
SocketError connect_to_any(SocketHandle socket, const std::vector<IpAddress>& remotes) {
    SocketError error;
    for (const IpAddress& remote : remotes) {
        error = connect_udp(socket, remote);
        if (!error) {
            break;
        }
    }
    return error;
}

// no_socket and `error` where it cannot be.
SocketHandle open_socket(const UdpSocket& wanted, const UdpAddress& local, const UdpAddress& remote,
                         bool loopback_only, std::string& error) {
    IpAddress here = loopback(wanted.family, local.port);
    if (!local.host.empty() || !loopback_only) {
        const std::vector<IpAddress> found = resolve(local, wanted.family, error);
        if (found.empty()) {
            std::string unknown;
            error = resolve(local, IpFamily::any, unknown).empty()
                        ? unknown
                        : family_error(local, remote, wanted.family);
            return no_socket;
        }
        here = found.front();
    }
    SocketError trouble;
    const SocketHandle made = open_udp(wanted.family, trouble);
    if (made == no_socket) {
        error = "the system gives no socket: " + system_message(trouble.code);
        return no_socket;
    }
    if ((trouble = bind_udp(made, here))) {
        error = bind_error(local, trouble);
    } else if ((trouble = connect_to_any(made, wanted.remotes))) {
        error = "there is no way to \"" + remote.host + "\": " + system_message(trouble.code);
    } else if (own_address(made) == far_address(made)) {
        error = own_address_error(remote);
    } else {
        return made;
    }
    close_udp(made);
    return no_socket;
}

}  // namespace

UdpSockets open_udp_sockets(const UdpAddress& local, const UdpAddress& remote, bool loopback_only) {
    UdpSockets opened;
    if (remote.host.empty() || remote.port == 0) {
        opened.error = "the other side has no address: set its address and its port";
        return opened;
    }
    std::vector<IpAddress> remotes = resolve(remote, IpFamily::any, opened.error);
    if (remotes.empty()) {
        return opened;
    }
    add_other_loopback(remotes);
    if (loopback_only) {
        std::erase_if(remotes, [](const IpAddress& address) { return !is_loopback(address); });
        if (remotes.empty()) {
            opened.error = "without a key this side talks within this machine only, and \"" + remote.host +
                           "\" is another one: give both sides the same key";
            return opened;
        }
    }
    UdpAddress bound = local;
    for (const IpFamily family : {IpFamily::six, IpFamily::four}) {
        UdpSocket socket{no_socket, family, {}, 0};
        std::ranges::copy_if(remotes, std::back_inserter(socket.remotes),
                             [family](const IpAddress& address) { return address.family == family; });
        if (socket.remotes.empty()) {
            continue;
        }
        socket.handle = open_socket(socket, bound, remote, loopback_only, opened.error);
        if (socket.handle != no_socket) {
            opened.local_port = bound.port = own_address(socket.handle).port;
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
        if (!connect_udp(socket.handle, socket.remotes[socket.remote])) {
            return;
        }
    }
}

std::size_t udp_overhead(IpFamily family) {
    constexpr std::size_t of_udp = 8, of_ip4 = 20, of_ip6 = 40;
    return of_udp + (family == IpFamily::six ? of_ip6 : of_ip4);
}

}  // namespace tactus
