// The way to the far side: datagrams that may be late, lost, doubled or out of order, never half or altered
// without notice.
#pragma once

#include <cstddef>
#include <span>

#include "core/math/types.hpp"

namespace tactus {

// The longest datagram (unit: bytes): what IPv6 carries everywhere without fragments, 1280, less the headers
// of IPv6 (40) and UDP (8).
inline constexpr std::size_t max_datagram_bytes = 1232;

// The longest message a sender may build (unit: bytes): leaves room for what a secured link wraps around it.
inline constexpr std::size_t max_message_bytes = 1184;

struct ReceivedDatagram {
    std::size_t bytes = 0;    // 0: nothing there
    Nanoseconds arrived = 0;  // when it came to this machine, on the clock of `now`; may be before this tick

    explicit operator bool() const { return bytes != 0; }
};

// Called by the haptic thread. Implementations neither allocate, lock, throw nor make a system call in send
// and receive; sockets and threads belong into their own set-up.
class Link {
public:
    virtual ~Link() = default;

    // `now` is the tick's own time on the session's clock, not a clock reading. False: the datagram was not
    // taken, because it is empty or too long, or because the link is full or closed; counted by the link.
    virtual bool send(std::span<const std::byte> datagram, Nanoseconds now) = 0;

    // The oldest datagram that is there by `now` and has not been taken. `into` holds max_datagram_bytes; a
    // datagram that does not fit is dropped and counted.
    virtual ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) = 0;

    // What the way adds to each datagram (unit: bytes): the headers of IPv4 and UDP where nothing else is
    // said.
    virtual std::size_t overhead() const { return 28; }
};

}  // namespace tactus
