#include "network/network_link.hpp"

#include <limits>

#include "network/endpoint.hpp"

namespace tactus {
namespace {

constexpr Nanoseconds publish_every = 50'000'000;

}  // namespace

std::string NetworkLink::open(const NetworkSettings& settings) {
    close();
    std::optional<SecretKey> key;
    if (!settings.key.empty()) {
        key = secret_key(settings.key);
        if (!key) {
            return "the key is too short: give 64 hexadecimal digits or at least 8 characters, the same on "
                   "both "
                   "sides";
        }
    }
    std::string error = udp_.open(settings.udp);
    if (!error.empty()) {
        return error;
    }
    emulator_ = std::make_unique<LinkEmulator>(udp_, settings.conditions, settings.seed);
    if (key) {
        secure_ = std::make_unique<SecureLink>(*emulator_, *key, random_epoch());
    }
    next_publish_ = std::numeric_limits<Nanoseconds>::min();
    return {};
}

void NetworkLink::close() {
    udp_.close();
    secure_.reset();
    emulator_.reset();
}

void NetworkLink::change(const LinkConditions& conditions) {
    if (emulator_) {
        emulator_->change(conditions);
    }
}

NetworkFigures NetworkLink::figures() {
    loop_figures_.refresh();
    const LoopFigures& loop = loop_figures_.front();
    return {udp_.figures(), loop.emulator, secure_ != nullptr, loop.key_met, loop.secure};
}

Link* NetworkLink::outermost() {
    return secure_ ? static_cast<Link*>(secure_.get()) : emulator_.get();
}

bool NetworkLink::send(std::span<const std::byte> datagram, Nanoseconds now) {
    Link* const link = outermost();
    return link != nullptr && link->send(datagram, now);
}

ReceivedDatagram NetworkLink::receive(std::span<std::byte> into, Nanoseconds now) {
    Link* const link = outermost();
    if (link == nullptr) {
        return {};
    }
    publish_when_due(now);
    return link->receive(into, now);
}

void NetworkLink::publish_when_due(Nanoseconds now) {
    if (now < next_publish_) {
        return;
    }
    next_publish_ = now + publish_every;
    LoopFigures& figures = loop_figures_.back();
    figures.emulator = emulator_->counts();
    figures.key_met = secure_ && secure_->met();
    figures.secure = secure_ ? secure_->counts() : SecureCounts{};
    loop_figures_.publish();
}

}  // namespace tactus
