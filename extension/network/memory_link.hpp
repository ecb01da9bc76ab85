// Two links that end in each other, inside one process: what one sends, the other receives at once.
//
// Threads: each end belongs to one thread; the two may be the same. All memory is taken in the constructor.
#pragma once

#include <array>
#include <cstring>

#include "core/ports/link.hpp"
#include "realtime/spsc_ring.hpp"

namespace tactus {

struct Datagram {
    std::array<std::byte, max_datagram_bytes> bytes;
    std::size_t size = 0;
    Nanoseconds arrived = 0;
};

using DatagramRing = SpscRing<Datagram>;

// Oldest out of `ring`; counts in `oversized` what does not fit into `into`.
inline ReceivedDatagram take_oldest(DatagramRing& ring, std::span<std::byte> into, std::uint64_t& oversized) {
    for (Datagram* oldest = ring.front(); oldest != nullptr; oldest = ring.front()) {
        const ReceivedDatagram received{oldest->size, oldest->arrived};
        const bool fits = received.bytes <= into.size();
        if (fits) {
            std::memcpy(into.data(), oldest->bytes.data(), received.bytes);
        }
        ring.pop();
        if (fits) {
            return received;
        }
        ++oversized;
    }
    return {};
}

// False where `datagram` is empty, too long or finds no room.
inline bool put_newest(DatagramRing& ring, std::span<const std::byte> datagram, Nanoseconds arrived) {
    if (datagram.empty() || datagram.size() > max_datagram_bytes) {
        return false;
    }
    Datagram newest;
    newest.size = datagram.size();
    newest.arrived = arrived;
    std::memcpy(newest.bytes.data(), datagram.data(), datagram.size());
    return ring.try_push(newest);
}

class MemoryLinkPair {
public:
    // Room for `capacity` datagrams each way.
    explicit MemoryLinkPair(std::size_t capacity = 1024)
        : forth_(capacity), back_(capacity), first_(forth_, back_), second_(back_, forth_) {}

    MemoryLinkPair(const MemoryLinkPair&) = delete;
    MemoryLinkPair& operator=(const MemoryLinkPair&) = delete;

    Link& first() { return first_; }
    Link& second() { return second_; }

    // Datagrams that were refused for want of room or for their size, by the end that sent them.
    std::uint64_t first_refused() const { return first_.refused(); }
    std::uint64_t second_refused() const { return second_.refused(); }

private:
    class End final : public Link {
    public:
        End(DatagramRing& out, DatagramRing& in) : out_(out), in_(in) {}

        bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
            const bool taken = put_newest(out_, datagram, now);
            refused_ += taken ? 0 : 1;
            return taken;
        }

        ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds) override {
            return take_oldest(in_, into, refused_);
        }

        std::uint64_t refused() const { return refused_; }

    private:
        DatagramRing& out_;
        DatagramRing& in_;
        std::uint64_t refused_ = 0;
    };

    DatagramRing forth_;
    DatagramRing back_;
    End first_;
    End second_;
};

}  // namespace tactus
