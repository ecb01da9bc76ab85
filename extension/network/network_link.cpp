#include "network/network_link.hpp"

#include <limits>

namespace tactus {
namespace {

constexpr Nanoseconds publish_every = 50'000'000;

}  // namespace

std::string NetworkLink::open(const NetworkSettings& settings) {
    close();
    UdpSettings udp = settings.udp;
    if (!settings.key.empty()) {
        udp.secret = shared_secret(settings.key);
        if (!udp.secret) {
            return "the key is too short: give 64 hexadecimal digits or at least 8 characters, the same on "
                   "both sides";
        }
    }
    std::string error = udp_.open(udp);
    if (!error.empty()) {
        return error;
    }
    emulator_ = std::make_unique<LinkEmulator>(udp_, settings.conditions, settings.seed);
    next_publish_ = std::numeric_limits<Nanoseconds>::min();
    return {};
}

void NetworkLink::close() {
    udp_.close();
    emulator_.reset();
}

void NetworkLink::change(const LinkConditions& conditions) {
    if (emulator_) {
        emulator_->change(conditions);
    }
}

NetworkFigures NetworkLink::figures() {
    emulator_counts_.refresh();
    return {udp_.figures(), emulator_counts_.front()};
}

bool NetworkLink::send(std::span<const std::byte> datagram, Nanoseconds now) {
    return emulator_ && emulator_->send(datagram, now);
}

ReceivedDatagram NetworkLink::receive(std::span<std::byte> into, Nanoseconds now) {
    if (!emulator_) {
        return {};
    }
    publish_when_due(now);
    return emulator_->receive(into, now);
}

void NetworkLink::publish_when_due(Nanoseconds now) {
    if (now >= next_publish_) {
        next_publish_ = now + publish_every;
        emulator_counts_.publish(emulator_->counts());
    }
}

}  // namespace tactus
