// The way to the far side as a scene asks for it: a socket, an emulated network on what comes in, and a key,
// each only where it is wanted.
//
// Threads: open(), close(), change() and figures() belong to the owner, send() and receive() to the haptic
// thread, which must not be using the link while it is opened or closed.
#pragma once

#include <memory>
#include <string>

#include "network/link_emulator.hpp"
#include "network/secure_link.hpp"
#include "network/udp_link.hpp"

namespace tactus {

struct NetworkSettings {
    UdpSettings udp;
    std::string key;            // see secret_key(); empty: packets are not sealed
    LinkConditions conditions;  // emulated on what comes in, sealed or not
    std::uint64_t seed = 1;     // of the emulation
};

struct NetworkFigures {
    UdpFigures udp;
    EmulatorCounts emulator;
    bool sealed = false;   // with a key
    bool key_met = false;  // the far side has shown that it has the same key
    SecureCounts secure;
};

class NetworkLink final : public Link {
public:
    // Off the loop. Empty text, or what is wrong and what to do.
    std::string open(const NetworkSettings& settings);
    void close();

    // The emulated network is another one from now on.
    void change(const LinkConditions& conditions);

    // As of the last tick but a few.
    NetworkFigures figures();

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override;
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override;

private:
    struct LoopFigures {
        EmulatorCounts emulator;
        bool key_met = false;
        SecureCounts secure;
    };

    Link* outermost();
    void publish_when_due(Nanoseconds now);

    UdpLink udp_;
    std::unique_ptr<LinkEmulator> emulator_;
    std::unique_ptr<SecureLink> secure_;  // null: no key
    TripleBuffer<LoopFigures> loop_figures_;
    Nanoseconds next_publish_ = 0;
};

}  // namespace tactus
