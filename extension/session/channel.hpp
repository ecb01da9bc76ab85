// What both sides of a teleoperation do with their end of the link alike: settings that the owner changes
// while the loop runs, another start of the far side, leaving, and what is told about it.
#pragma once

#include <memory>

#include "session/teleop_port.hpp"

namespace tactus {

class Channel {
public:
    Channel(const TeleopSettings& settings, Link& link, std::shared_ptr<TeleopPort> port,
            const EndpointSettings& endpoint)
        : settings_(settings), before_(settings), link_(link, endpoint), port_(std::move(port)) {}

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

    // Last thing in a tick: what is due goes out, and the owner is told.
    void end_tick(TeleopStatistics& statistics);

    Endpoint& link() { return link_; }
    const Endpoint& link() const { return link_; }
    TeleopPort& port() { return *port_; }

private:
    TeleopSettings settings_, before_;
    Endpoint link_;
    std::shared_ptr<TeleopPort> port_;
    std::uint64_t peer_epoch_ = 0;
    std::uint64_t starts_ = 0;  // of the far side, seen so far
};

}  // namespace tactus
