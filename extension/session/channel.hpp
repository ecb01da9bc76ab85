// What both sides of a teleoperation do with their end of the link alike: settings that the owner changes
// while the loop runs, another start of the far side, leaving, what both must agree on, and what is told
// about it.
#pragma once

#include <memory>

#include "session/teleop_port.hpp"

namespace tactus {

class Channel {
public:
    Channel(const TeleopSettings& settings, Link& link, std::shared_ptr<TeleopPort> port,
            const EndpointSettings& endpoint);

    // First thing in a tick. True where the owner has given other settings; before() is what they were.
    bool begin_tick(Nanoseconds now);
    const TeleopSettings& settings() const { return settings_; }
    const TeleopSettings& before() const { return before_; }

    // True once for each start of the far side, the first one included. To be asked before what is received
    // is used: nothing that an earlier start has said holds any more.
    bool peer_has_started();
    bool peer_has_restarted() const { return starts_ > 1; }

    // The next message, or null. Valid until the next call.
    const Packet* receive();

    void send(const Message& message) { link_.send(message); }
    bool try_send(const Message& message) { return link_.send(message); }

    // --- what both sides must agree on

    // What this side's settings say of it; bodies and hands are the side's to add.
    Terms terms_of_settings() const;
    // Once a tick.
    void set_own(const Terms& terms);
    // While the far side is heard: what differs, or that it has not said yet. Else nothing does.
    const Disagreement& disagreement() const { return disagreement_; }
    bool works_together(std::size_t hand) const { return disagreement_.works(hand); }

    // Last thing in a tick: what is due goes out, and the owner is told.
    void end_tick(TeleopStatistics& statistics);

    Endpoint& link() { return link_; }
    const Endpoint& link() const { return link_; }
    TeleopPort& port() { return *port_; }

private:
    void take(const Terms& terms, std::uint64_t packet);
    void compare_terms();
    bool waits_for_terms() const;
    Disagreement found() const;

    TeleopSettings settings_, before_;
    Endpoint link_;
    std::shared_ptr<TeleopPort> port_;
    std::uint64_t peer_epoch_ = 0;
    std::uint64_t starts_ = 0;  // of the far side, seen so far
    Side side_;
    Terms own_, peer_;
    bool own_changed_ = true;
    Nanoseconds met_at_ = 0;               // the far side's last start was heard
    Nanoseconds told_at_ = 0;              // own_ was sent last
    std::uint64_t hellos_ = 0;             // since the far side's last start
    std::uint64_t peer_terms_epoch_ = 0;   // whose peer_ is; 0: not known
    std::uint64_t peer_terms_packet_ = 0;  // that brought it
    Disagreement disagreement_;
    Nanoseconds now_ = 0;        // of the tick
    Nanoseconds agreed_at_ = 0;  // last
    bool has_agreed_ = false;    // with this start of the far side
};

}  // namespace tactus
