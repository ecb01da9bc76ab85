#include "network/udp_link.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "realtime/clock.hpp"
#include "realtime/realtime_thread.hpp"

namespace tactus {
namespace {

// Room in the system for a few hundred datagrams while the thread is not let onto a processor.
constexpr int system_buffer_bytes = 1 << 20;

// Of what has come in before what is to be sent is looked at again.
constexpr int most_at_once = 64;

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses resolve(const std::string& host, std::uint16_t port, int family, bool own, std::string& error) {
    addrinfo hints{};
    hints.ai_family = family;
    hints.ai_socktype = SOCK_DGRAM;
    hints.ai_flags = AI_NUMERICSERV | (own ? AI_PASSIVE : 0);
    addrinfo* found = nullptr;
    const int code =
        getaddrinfo(host.empty() ? nullptr : host.c_str(), std::to_string(port).c_str(), &hints, &found);
    if (code != 0) {
        error = "the address \"" + host + "\" is not known: " + gai_strerror(code);
        found = nullptr;
    }
    return {found, &freeaddrinfo};
}

std::string bind_error(std::uint16_t port, int error) {
    const std::string place = "port " + std::to_string(port);
    if (error == EADDRINUSE) {
        return place + " is in use by another program: end that one or choose another port";
    }
    if (error == EACCES) {
        return place + " is reserved for the system: choose one from 1024 to 65535";
    }
    if (error == EADDRNOTAVAIL) {
        return "the local address is not one of this machine: leave it empty to listen on all of its "
               "addresses";
    }
    return place + " cannot be used: " + std::strerror(error);
}

std::uint16_t bound_port(int socket) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
        return 0;
    }
    return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                                               : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

// A socket bound here and connected there, so that the system drops what comes from anywhere else and says
// when nobody listens. -1 and `error` where it cannot be.
int connected_socket(const UdpSettings& settings, std::string& error) {
    const Addresses there = resolve(settings.remote_address, settings.remote_port, AF_UNSPEC, false, error);
    if (there == nullptr) {
        return -1;
    }
    const Addresses here =
        resolve(settings.local_address, settings.local_port, there->ai_family, true, error);
    if (here == nullptr) {
        return -1;
    }
    const int made = socket(there->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (made < 0) {
        error = std::string("the system gives no socket: ") + std::strerror(errno);
        return -1;
    }
    setsockopt(made, SOL_SOCKET, SO_RCVBUF, &system_buffer_bytes, sizeof system_buffer_bytes);
    setsockopt(made, SOL_SOCKET, SO_SNDBUF, &system_buffer_bytes, sizeof system_buffer_bytes);
    if (bind(made, here->ai_addr, here->ai_addrlen) != 0) {
        error = bind_error(settings.local_port, errno);
    } else if (connect(made, there->ai_addr, there->ai_addrlen) != 0) {
        error = "there is no way to \"" + settings.remote_address + "\": " + std::strerror(errno);
    } else {
        return made;
    }
    ::close(made);
    return -1;
}

// Counts up what one thread writes and others read.
void count(std::atomic<std::uint64_t>& counter) {
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace

std::string UdpLink::open(const UdpSettings& settings) {
    close();
    if (settings.remote_address.empty() || settings.remote_port == 0) {
        return "the far side has no address: set its address and its port";
    }
    std::string error;
    socket_ = connected_socket(settings, error);
    if (socket_ < 0) {
        return error;
    }
    settings_ = settings;
    local_port_ = bound_port(socket_);
    outgoing_ = std::make_unique<DatagramRing>(settings.capacity);
    incoming_ = std::make_unique<DatagramRing>(settings.capacity);
    stop_event_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    stop_requested_.store(false);
    state_.store(UdpState::open);
    const int code = stop_event_ < 0 ? errno : pthread_create(&thread_, nullptr, &UdpLink::run_thread, this);
    if (stop_event_ < 0 || code != 0) {
        close();
        return std::string("the network thread could not be created: ") + std::strerror(code);
    }
    running_ = true;
    return {};
}

void UdpLink::close() {
    if (running_) {
        stop_requested_.store(true);
        const std::uint64_t one = 1;
        [[maybe_unused]] const ssize_t written = write(stop_event_, &one, sizeof one);
        pthread_join(thread_, nullptr);
        running_ = false;
    }
    for (int* file : {&socket_, &stop_event_}) {
        if (*file >= 0) {
            ::close(*file);
            *file = -1;
        }
    }
    local_port_ = 0;
    state_.store(UdpState::closed);
}

bool UdpLink::send(std::span<const std::byte> datagram, Nanoseconds now) {
    if (outgoing_ == nullptr || !put_newest(*outgoing_, datagram, now)) {
        no_room_to_send_.fetch_add(1, std::memory_order_relaxed);
        return false;
    }
    return true;
}

ReceivedDatagram UdpLink::receive(std::span<std::byte> into, Nanoseconds) {
    if (incoming_ == nullptr) {
        return {};
    }
    std::uint64_t oversized = 0;
    const ReceivedDatagram received = take_oldest(*incoming_, into, oversized);
    if (oversized > 0) {
        oversized_.fetch_add(oversized, std::memory_order_relaxed);
    }
    return received;
}

UdpFigures UdpLink::figures() const {
    const auto read = [](const std::atomic<std::uint64_t>& counter) {
        return counter.load(std::memory_order_relaxed);
    };
    return {state_.load(std::memory_order_relaxed),
            read(sent_),
            read(received_),
            read(no_room_to_send_),
            read(no_room_to_take_),
            read(oversized_),
            read(unreachable_)};
}

void* UdpLink::run_thread(void* self) {
    static_cast<UdpLink*>(self)->run();
    return nullptr;
}

void UdpLink::run() {
    pthread_setname_np(pthread_self(), "tactus-network");
    RealtimeRequest request;
    request.fifo_priority = settings_.fifo_priority;
    request.cpu = any_processor;
    request.lock_memory = false;
    const RealtimeReport report = make_thread_realtime(request);
    while (!stop_requested_.load(std::memory_order_relaxed)) {
        send_waiting();
        if (!receive_waiting()) {
            wait_for_work();
        }
    }
    send_waiting();  // a bye that was said just before
    release_realtime(report);
}

void UdpLink::send_waiting() {
    while (const Datagram* oldest = outgoing_->front()) {
        if (::send(socket_, oldest->bytes.data(), oldest->size, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) {
            count(sent_);
        } else if (errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS) {
            no_room_to_send_.fetch_add(1, std::memory_order_relaxed);
        } else {
            note_error(errno);
        }
        outgoing_->pop();
    }
}

// Whether there may be more.
bool UdpLink::receive_waiting() {
    Datagram datagram;
    for (int i = 0; i < most_at_once; ++i) {
        const ssize_t size =
            recv(socket_, datagram.bytes.data(), datagram.bytes.size(), MSG_DONTWAIT | MSG_TRUNC);
        if (size < 0) {
            if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) {
                note_error(errno);
            }
            return false;
        }
        datagram.arrived = monotonic_now();
        datagram.size = static_cast<std::size_t>(size);
        if (datagram.size > most_datagram_bytes) {
            oversized_.fetch_add(1, std::memory_order_relaxed);
        } else if (datagram.size == 0) {
            continue;
        } else if (incoming_->try_push(datagram)) {
            count(received_);
            state_.store(UdpState::open, std::memory_order_relaxed);
        } else {
            count(no_room_to_take_);
        }
    }
    return true;
}

// An unreachable far side is asked on: it may be about to start.
void UdpLink::note_error(int error) {
    if (error == ECONNREFUSED || error == EHOSTUNREACH || error == ENETUNREACH) {
        count(unreachable_);
        state_.store(UdpState::unreachable, std::memory_order_relaxed);
    } else {
        state_.store(UdpState::failed, std::memory_order_relaxed);
    }
}

void UdpLink::wait_for_work() {
    pollfd files[2] = {{socket_, POLLIN, 0}, {stop_event_, POLLIN, 0}};
    const timespec timeout = to_timespec(settings_.look_out);
    ppoll(files, 2, &timeout, nullptr);
    if ((files[0].revents & (POLLERR | POLLNVAL)) != 0 && state_.load() == UdpState::failed) {
        // Nothing to wait for any more; do not spin.
        ppoll(&files[1], 1, &timeout, nullptr);
    }
}

}  // namespace tactus
