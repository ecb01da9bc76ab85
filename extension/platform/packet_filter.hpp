// Programs by which the system itself drops datagrams before a thread is woken and before anything is copied.
#pragma once

#include <cstdint>
#include <span>

#include "platform/udp_socket.hpp"

namespace tactus {

// A step of the classic packet filter (BPF). What it sees of a datagram begins with the header of UDP; a load
// beyond the end drops the datagram.
struct FilterStep {
    enum Code : std::uint16_t {
        load_word = 0x20,         // four bytes at `value`, in the network's order
        load_half = 0x28,         // two bytes there
        load_length = 0x80,       // of the whole datagram
        jump_if_equal = 0x15,     // what is loaded, to `value`
        jump_if_at_least = 0x35,  // what is loaded, `value`
        end_with = 0x06,          // as many bytes as `value` says pass; 0: it is dropped
    };

    Code code;
    std::uint8_t skip_if_true = 0, skip_if_false = 0;  // steps; of a jump
    std::uint32_t value = 0;
};

// From now on only what passes comes. False where the system cannot: then everything comes.
bool filter_udp(SocketHandle socket, std::span<const FilterStep> program);

// Datagrams that the system dropped so far, for want of room included; 0 where it does not say.
std::uint64_t dropped_by_system(SocketHandle socket);

}  // namespace tactus
