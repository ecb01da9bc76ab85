// The way to the far side as a scene asks for it: a socket, a key, and an emulated network on what comes in,
// each only where it is wanted.
//
// Threads: open(), close(), change() and figures() belong to the owner, send() and receive() to the haptic
// thread, which must not be using the link while it is opened or closed.
#pragma once

#include <memory>
#include <string>

#include "network/link_emulator.hpp"
#include "network/udp_link.hpp"

namespace tactus {

struct NetworkSettings {
    UdpSettings udp;
    std::string key;            // see shared_secret(); empty: nothing is sealed, and it stays on this machine
    LinkConditions conditions;  // emulated on what comes in, when it has been opened
    std::uint64_t seed = 1;     // of the emulation
};

struct NetworkFigures {
    UdpFigures udp;
    EmulatorCounts emulator;

    // What sealing adds to each packet (unit: bytes).
    std::size_t sealing() const { return udp.sealed ? SecureSession::overhead : 0; }
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
    std::size_t overhead() const override { return udp_.overhead(); }

private:
    void publish_when_due(Nanoseconds now);

    UdpLink udp_;
    std::unique_ptr<LinkEmulator> emulator_;
    TripleBuffer<EmulatorCounts> emulator_counts_;
    Nanoseconds next_publish_ = 0;
};

}  // namespace tactus
