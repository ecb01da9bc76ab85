// A link over UDP.
//
// Threads: open() and close() belong to the owner; send() and receive() to the haptic thread; figures() to
// anybody. The link has a thread of its own that owns the socket, and it alone makes system calls: the haptic
// thread only touches two rings. Since waking a sleeping thread is a system call as well, nobody wakes it: it
// wakes by itself, at once when a datagram comes in, and every `look_out` to see what there is to send. That
// is what sending takes longer for.
#pragma once

#include <pthread.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "network/memory_link.hpp"

namespace tactus {

struct UdpSettings {
    std::string local_address;       // a number or name of this machine; empty: any
    std::uint16_t local_port = 0;    // 0: any that is free
    std::string remote_address;      // a number or name; only what comes from there is taken
    std::uint16_t remote_port = 0;   // of the far side, > 0
    Nanoseconds look_out = 200'000;  // > 0
    std::size_t capacity = 1024;     // datagrams that wait, each way
    int fifo_priority = 60;          // below the haptic thread's; 0: the ordinary scheduler
};

enum class UdpState : std::uint8_t {
    closed,
    open,
    unreachable,  // the far machine says that nobody listens there
    failed,       // the system has taken the socket away, or refuses to send
};

struct UdpFigures {
    UdpState state = UdpState::closed;
    std::uint64_t sent = 0;             // given to the system
    std::uint64_t received = 0;         // given to the haptic thread's ring
    std::uint64_t no_room_to_send = 0;  // lost: the ring or the system was full
    std::uint64_t no_room_to_take = 0;  // lost: the haptic thread did not come to take them
    std::uint64_t oversized = 0;        // longer than most_datagram_bytes, dropped
    std::uint64_t unreachable = 0;      // times that the far machine said so
};

class UdpLink final : public Link {
public:
    UdpLink() = default;
    ~UdpLink() override { close(); }
    UdpLink(const UdpLink&) = delete;
    UdpLink& operator=(const UdpLink&) = delete;

    // Off the loop: may ask the network for a name. Empty text, or what is wrong and what to do.
    std::string open(const UdpSettings& settings);
    void close();

    std::uint16_t local_port() const { return local_port_; }  // 0 while closed

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override;
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override;

    UdpFigures figures() const;

private:
    static void* run_thread(void* self);
    void run();
    void send_waiting();
    bool receive_waiting();
    void note_error(int error);
    void wait_for_work();

    UdpSettings settings_;
    int socket_ = -1;
    int stop_event_ = -1;
    std::uint16_t local_port_ = 0;
    pthread_t thread_{};
    bool running_ = false;
    std::atomic<bool> stop_requested_{false};
    std::unique_ptr<DatagramRing> outgoing_;
    std::unique_ptr<DatagramRing> incoming_;

    std::atomic<UdpState> state_{UdpState::closed};
    std::atomic<std::uint64_t> sent_{0};
    std::atomic<std::uint64_t> received_{0};
    std::atomic<std::uint64_t> no_room_to_send_{0};
    std::atomic<std::uint64_t> no_room_to_take_{0};
    std::atomic<std::uint64_t> oversized_{0};
    std::atomic<std::uint64_t> unreachable_{0};
};

}  // namespace tactus
