// Sending and receiving of one side: numbers its packets, believes no packet that is broken, and hands to the
// owner what is not for the loop. Private to session/.
#pragma once

#include <memory>

#include "session/teleop_port.hpp"

namespace tactus {

class TeleopLink {
public:
    // The link lives longer. `epoch`: another one at each start, never 0.
    TeleopLink(Link& link, std::shared_ptr<TeleopPort> port, std::uint64_t epoch)
        : link_(link), port_(std::move(port)), epoch_(epoch) {}

    bool send(const Message& message, Nanoseconds now);
    // Letters of the owner.
    void send_outgoing(Nanoseconds now);

    // The next packet for the loop that is there by `now`; false where there is none.
    bool receive(Packet& packet, Nanoseconds now);

    // A packet of another epoch than those before; true once for each.
    bool peer_is_new();
    bool peer_present(Nanoseconds now, Nanoseconds patience) const {
        return peer_epoch_ != 0 && now - last_heard_ < patience;
    }

    std::uint64_t epoch() const { return epoch_; }
    std::uint64_t peer_epoch() const { return peer_epoch_; }
    TeleopPort& port() { return *port_; }
    void count(TeleopStatistics& statistics) const;

private:
    Link& link_;
    std::shared_ptr<TeleopPort> port_;
    std::uint64_t epoch_;
    std::uint64_t sequence_ = 0;
    std::uint64_t peer_epoch_ = 0;
    std::uint64_t epoch_before_ = 0;  // of the peer's start before this one: late packets of it are no start
    bool peer_is_new_ = false;
    Nanoseconds last_heard_ = 0;
    std::uint64_t sent_ = 0, bytes_sent_ = 0, received_ = 0, bytes_received_ = 0, not_taken_ = 0;
    std::uint64_t restarts_ = 0;
    RefusalCounts refused_;
    std::array<std::byte, most_datagram_bytes> buffer_;
};

}  // namespace tactus
