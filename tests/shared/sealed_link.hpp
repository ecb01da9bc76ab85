// A link whose datagrams are sealed in the caller's own thread, for virtual time. A real one seals in its
// network thread (network/udp_link.hpp).
#pragma once

#include <array>
#include <functional>

#include "core/ports/link.hpp"
#include "network/secure_session.hpp"

namespace tactus::shared {

class SealedLink final : public Link {
public:
    SealedLink(Link& inner, const SharedSecret& secret, const SecureIdentity& own = random_identity())
        : inner_(inner), session_(secret, own, [](std::function<void()> job) { job(); }) {}

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
        const std::size_t size = session_.seal(datagram, sealed_);
        return size > 0 && inner_.send(std::span(sealed_).first(size), now);
    }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
        while (const std::size_t size = session_.due(sealed_, now)) {
            inner_.send(std::span(sealed_).first(size), now);
        }
        while (const ReceivedDatagram received = inner_.receive(sealed_, now)) {
            if (const std::size_t size = session_.open(std::span(sealed_).first(received.bytes), into, now)) {
                return {size, received.arrived};
            }
        }
        return {};
    }
    std::size_t overhead() const override { return inner_.overhead() + SecureSession::overhead; }

    const SecureSession& session() const { return session_; }

private:
    Link& inner_;
    SecureSession session_;
    std::array<std::byte, max_datagram_bytes> sealed_;
};

}  // namespace tactus::shared
