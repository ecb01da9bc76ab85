// A link over UDP, under a secret where there is one.
//
// Threads: open() and close() belong to the owner; send() and receive() to the haptic thread; figures() to
// the owner. The link has a thread of its own that owns the sockets and the secure session, and it alone
// makes system calls and opens what is sealed: the haptic thread only touches two rings. Since waking a
// sleeping thread is a system call as well, nobody wakes it: it wakes by itself, at once when a datagram
// comes in, and every `look_out` to see what there is to send. That is what sending takes longer for.
//
// A flood costs the haptic thread nothing and the network thread little: what is not sealed for this session
// is dropped by the system (socket_filter.hpp), the rest is taken in batches, at most one every `look_out`,
// and what comes faster than any honest side sends is dropped before anything is done for it.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "network/doorman.hpp"
#include "network/job_thread.hpp"
#include "network/memory_link.hpp"
#include "network/rate_limit.hpp"
#include "network/secure_session.hpp"
#include "network/socket_filter.hpp"
#include "network/udp_sockets.hpp"
#include "platform/thread.hpp"
#include "realtime/triple_buffer.hpp"

namespace tactus {

struct UdpSettings {
    std::string local_address;           // a number or name of this machine; empty: any (see `secret`)
    std::uint16_t local_port = 0;        // 0: any that is free
    std::string remote_address;          // a number or name; only what comes from there is taken
    std::uint16_t remote_port = 0;       // of the far side, > 0
    std::optional<SharedSecret> secret;  // none: nothing is sealed, and only this machine is talked to
    Nanoseconds look_out = 200'000;      // > 0
    std::size_t capacity = 1024;         // datagrams that wait, each way
    int fifo_priority = 60;              // below the haptic thread's; 0: the ordinary scheduler
};

enum class UdpState : std::uint8_t {
    closed,
    open,
    unreachable,  // the far machine says that nobody listens there
    failed,       // the system has taken the socket away, or refuses to send
};

struct UdpFigures {
    UdpState state = UdpState::closed;
    std::uint64_t sent = 0;               // given to the system
    std::uint64_t received = 0;           // given to the haptic thread's ring
    std::uint64_t no_room_to_send = 0;    // lost: the ring or the system was full
    std::uint64_t no_room_to_take = 0;    // lost: the haptic thread did not come to take them
    std::uint64_t oversized = 0;          // longer than max_datagram_bytes, dropped
    std::uint64_t unreachable = 0;        // times that the far machine said so
    std::uint64_t too_many = 0;           // came faster than any honest side sends, dropped
    std::uint64_t refused = 0;            // times that the far side said that it expects somebody else
    std::uint64_t dropped_by_system = 0;  // unseen: not for this session, or no room
    bool sealed = false;                  // under a secret
    bool met = false;                     // the far side has shown that it knows the same secret
    SecureCounts secure;
};

class UdpLink final : public Link {
public:
    UdpLink();
    ~UdpLink() override;
    UdpLink(const UdpLink&) = delete;
    UdpLink& operator=(const UdpLink&) = delete;

    // Off the loop: may ask the network for a name. Empty text, or what is wrong and what to do.
    std::string open(const UdpSettings& settings);
    void close();

    std::uint16_t local_port() const { return sockets_.local_port; }  // 0 while closed

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override;
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override;
    std::size_t overhead() const override { return overhead_.load(std::memory_order_relaxed); }

    UdpFigures figures();

private:
    struct SecureFigures {
        bool met = false;
        SecureCounts counts;
        std::uint64_t dropped_by_system = 0;
    };
    // A second of the most that an honest side sends passes at once.
    static constexpr Nanoseconds one_every = 50'000;
    static constexpr std::int64_t burst = 512;
    static constexpr std::size_t undecided = ~std::size_t{0};

    void run();
    void send_waiting();
    void say_what_is_due();
    void send_to_far_side(std::span<const std::byte> datagram);
    std::size_t receive_waiting();
    std::size_t receive_from(std::size_t which);
    void take(std::size_t which, std::span<const std::byte> datagram, Nanoseconds arrived);
    bool is_refused(std::span<const std::byte> datagram, Nanoseconds now);
    void decide_for(std::size_t which);
    void filter(Nanoseconds now);
    void try_other_addresses(Nanoseconds now);
    void publish(Nanoseconds now);
    void note_error(SocketError error);
    void wait_for_work(std::size_t received);

    UdpSettings settings_;
    UdpSockets sockets_;
    std::unique_ptr<SocketWait> wait_;  // null: closed
    Thread thread_;
    std::atomic<bool> stop_requested_{false};
    std::unique_ptr<DatagramRing> outgoing_;
    std::unique_ptr<DatagramRing> incoming_;

    // Of the network thread.
    DatagramBatch batch_{max_datagram_bytes};
    std::array<std::byte, max_datagram_bytes> sealed_;
    std::array<Doorman, 2> doormen_;         // of each socket
    std::unique_ptr<SecureSession> secure_;  // null: no secret
    std::unique_ptr<JobThread> jobs_;        // makes its keys
    std::optional<Admission> admitted_;      // by the system
    RateLimit limit_{one_every, burst};
    std::size_t chosen_ = undecided;  // the socket that the far side was heard on
    Nanoseconds next_try_ = 0;
    Nanoseconds next_publish_ = 0;
    TripleBuffer<SecureFigures> secure_figures_;

    std::atomic<UdpState> state_{UdpState::closed};
    std::atomic<std::size_t> overhead_{28};
    std::atomic<std::uint64_t> sent_{0};
    std::atomic<std::uint64_t> received_{0};
    std::atomic<std::uint64_t> no_room_to_send_{0};
    std::atomic<std::uint64_t> no_room_to_take_{0};
    std::atomic<std::uint64_t> oversized_{0};
    std::atomic<std::uint64_t> unreachable_{0};
    std::atomic<std::uint64_t> too_many_{0};
    std::atomic<std::uint64_t> refused_{0};
};

}  // namespace tactus
