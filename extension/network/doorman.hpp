// Tells whoever knocks at a port of this side that belongs to somebody else why nobody answers.
//
// A side's own socket hears its far side alone. This one is bound to the same place and gets what everybody
// else sends there. It says little and seldom: less than what it answers, only to what looks like a knock, a
// few times a second whatever comes, so that it is of no use for sending floods at others. What it says is
// neither sealed nor believed: it becomes a sentence on a screen.
//
// Belongs to the network thread but for open() and close().
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/math/types.hpp"
#include "network/sealed_format.hpp"
#include "platform/udp_socket.hpp"

namespace tactus {

using RefusalBytes = std::array<std::byte, sealed_format::refusal_bytes>;
RefusalBytes refusal_of(std::uint64_t number, sealed_format::Reason reason);

// What knocks calls itself: the start of a greeting, or the epoch of a hello without a key. Nothing where it
// is neither.
std::optional<std::uint64_t> number_of_knock(std::span<const std::byte> datagram);

// What is refused, of a refusal; nothing where it is none.
std::optional<std::uint64_t> number_of_refusal(std::span<const std::byte> datagram);

class Doorman {
public:
    Doorman() = default;
    ~Doorman() { close(); }
    Doorman(const Doorman&) = delete;
    Doorman& operator=(const Doorman&) = delete;

    // Beside a socket that is bound and connected. Where the system has no such thing nobody is told
    // anything.
    void open(SocketHandle beside, IpFamily family);
    void close();

    // Answers a few of those that wait, when due; the system drops the rest.
    void answer(Nanoseconds now);

private:
    SocketHandle socket_ = no_socket;
    Nanoseconds next_look_ = 0;
};

}  // namespace tactus
