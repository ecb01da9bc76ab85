// What experiments of teleoperation do to a link, beside the emulator's delay and loss.
#pragma once

#include <array>
#include <map>
#include <random>
#include <span>

#include "core/ports/link.hpp"
#include "network/messages.hpp"

namespace tactus::shared {

// A far side that sees bodies only roughly: what it says of their places is off by chance. Whoever sees so
// sees what stands elsewhere each time, and says so five times a second.
class RoughSight final : public Link {
public:
    RoughSight(Link& inner, double deviation, std::uint64_t seed)
        : inner_(inner), deviation_(deviation), random_(seed) {}

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
        return inner_.send(datagram, now);
    }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
        ReceivedDatagram received = inner_.receive(into, now);
        Packet packet;
        if (deviation_ > 0.0 && received && decode(into.first(received.bytes), packet) == Refusal::none) {
            if (auto* const states = std::get_if<ObjectStates>(&packet.message)) {
                look_again(*states, now);
                for (std::size_t i = 0; i < states->count; ++i) {
                    states->states[i].pose.position += off();
                }
                received.bytes = encode(packet.header, packet.message, into);
            }
        }
        return received;
    }

private:
    static constexpr Nanoseconds look_every = 200'000'000;
    struct Seen {
        ObjectState state;
        Nanoseconds at = 0;
    };

    // What has not been told of for a while goes along with what is.
    void look_again(ObjectStates& states, Nanoseconds now) {
        for (std::size_t i = 0; i < states.count; ++i) {
            seen_[states.states[i].object] = {states.states[i], now};
        }
        for (auto& [object, seen] : seen_) {
            if (now - seen.at >= look_every && states.count < ObjectStates::max_count) {
                seen.at = now;
                states.states[states.count++] = seen.state;
            }
        }
    }
    Vec3 off() {
        std::normal_distribution<double> normal(0.0, deviation_);
        return {normal(random_), normal(random_), normal(random_)};
    }

    Link& inner_;
    double deviation_;
    std::mt19937_64 random_;
    std::map<ObjectId, Seen> seen_;
};

// A link that can be cut: from then on nothing arrives.
class CutLink final : public Link {
public:
    explicit CutLink(Link& inner) : inner_(inner) {}

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
        return inner_.send(datagram, now);
    }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
        ReceivedDatagram received = inner_.receive(into, now);
        while (cut && received) {
            received = inner_.receive(into, now);
        }
        return received;
    }

    bool cut = false;

private:
    Link& inner_;
};

// Nobody listens yet.
inline void drop_all(Link& link, Nanoseconds now) {
    std::array<std::byte, max_datagram_bytes> ignored;
    while (link.receive(ignored, now)) {
    }
}

}  // namespace tactus::shared
