#include "world/link_way.hpp"

#include <limits>

#include "platform/clock.hpp"

namespace tactus {

namespace {

constexpr Nanoseconds publish_every = 50'000'000;

}  // namespace

InProcessWay::InProcessWay(std::shared_ptr<MemoryLinkPair> pair, bool first, const LinkConditions& conditions,
                           std::uint64_t seed)
    : end_(std::move(pair), first),
      emulator_(end_, conditions, seed),
      next_publish_(std::numeric_limits<Nanoseconds>::min()) {}

NetworkFigures InProcessWay::figures() {
    counts_.refresh();
    NetworkFigures figures;
    figures.emulator = counts_.front();
    return figures;
}

bool InProcessWay::send(std::span<const std::byte> datagram, Nanoseconds now) {
    return emulator_.send(datagram, now);
}

ReceivedDatagram InProcessWay::receive(std::span<std::byte> into, Nanoseconds now) {
    if (now >= next_publish_) {
        next_publish_ = now + publish_every;
        counts_.publish(emulator_.counts());
    }
    return emulator_.receive(into, now);
}

Nanoseconds UdpWay::ahead(Nanoseconds now) const {
    return ahead_ != nullptr ? ahead_->load(std::memory_order_relaxed) : monotonic_now() - now;
}

bool UdpWay::send(std::span<const std::byte> datagram, Nanoseconds now) {
    return link_.send(datagram, now + ahead(now));
}

ReceivedDatagram UdpWay::receive(std::span<std::byte> into, Nanoseconds now) {
    const Nanoseconds shift = ahead(now);
    const ReceivedDatagram received = link_.receive(into, now + shift);
    return {received.bytes, received.arrived - shift};
}

bool LinkRoute::send(std::span<const std::byte> datagram, Nanoseconds now) {
    LinkWay* const way = used_.load(std::memory_order_relaxed);
    return way != nullptr && way->send(datagram, now);
}

ReceivedDatagram LinkRoute::receive(std::span<std::byte> into, Nanoseconds now) {
    take();
    LinkWay* const way = used_.load(std::memory_order_relaxed);
    return way != nullptr ? way->receive(into, now) : ReceivedDatagram{};
}

}  // namespace tactus
