// The ways that an MMTLink can take to the far side, and the place where one is exchanged for another while
// the loop runs.
//
// Threads: send() and receive() belong to the haptic thread, all else to the main thread. The main thread
// puts a way in and takes none apart before is_taken(): neither waits for the other.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "network/memory_link.hpp"
#include "network/network_link.hpp"

namespace tactus {

// One way. Its times are the session's.
class LinkWay : public Link {
public:
    // The emulated network is another one from now on.
    virtual void change(const LinkConditions& conditions) = 0;
    // As of the last tick but a few. Without a socket only the emulator has any.
    virtual NetworkFigures figures() = 0;
};

// To an MMTLink of the same process. What comes in has arrived with the tick that finds it: the two sides'
// ticks need not be on one clock.
class InProcessWay final : public LinkWay {
public:
    InProcessWay(std::shared_ptr<MemoryLinkPair> pair, bool first, const LinkConditions& conditions,
                 std::uint64_t seed);

    void change(const LinkConditions& conditions) override { emulator_.change(conditions); }
    NetworkFigures figures() override;
    bool send(std::span<const std::byte> datagram, Nanoseconds now) override;
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override;

private:
    class End final : public Link {
    public:
        End(std::shared_ptr<MemoryLinkPair> pair, bool first)
            : pair_(std::move(pair)), link_(first ? pair_->first() : pair_->second()) {}
        bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
            return link_.send(datagram, now);
        }
        ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
            return {link_.receive(into, now).bytes, now};
        }

    private:
        std::shared_ptr<MemoryLinkPair> pair_;
        Link& link_;
    };

    End end_;
    LinkEmulator emulator_;
    TripleBuffer<EmulatorCounts> counts_;
    Nanoseconds next_publish_ = 0;
};

// Over UDP, where times are those of the machine's monotonic clock.
class UdpWay final : public LinkWay {
public:
    // `ahead`: of that clock before the session's, as the loop keeps it; null where time is stepped: there
    // the way passes in real time, whatever the session's clock does.
    explicit UdpWay(const std::atomic<Nanoseconds>* ahead) : ahead_(ahead) {}

    // Takes a while: may ask the network for a name, and stretches a passphrase. Empty text, or what is wrong
    // and what to do.
    std::string open(const NetworkSettings& settings) { return link_.open(settings); }

    void change(const LinkConditions& conditions) override { link_.change(conditions); }
    NetworkFigures figures() override { return link_.figures(); }
    bool send(std::span<const std::byte> datagram, Nanoseconds now) override;
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override;
    std::size_t overhead() const override { return link_.overhead(); }

private:
    Nanoseconds ahead(Nanoseconds now) const;

    const std::atomic<Nanoseconds>* ahead_;
    NetworkLink link_;
};

class LinkRoute final : public Link {
public:
    // From the loop's next tick on; null: what is sent is refused and nothing comes.
    void put(LinkWay* way) { wanted_.store(way, std::memory_order_release); }
    // The loop does not use any earlier way any more.
    bool is_taken() const {
        return used_.load(std::memory_order_acquire) == wanted_.load(std::memory_order_relaxed);
    }
    // Where no loop ticks, its thread's part is done by the caller.
    void take() { used_.store(wanted_.load(std::memory_order_acquire), std::memory_order_release); }

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override;
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override;
    std::size_t overhead() const override {
        const LinkWay* const way = used_.load(std::memory_order_relaxed);
        return way != nullptr ? way->overhead() : Link::overhead();
    }

private:
    std::atomic<LinkWay*> wanted_{nullptr};
    std::atomic<LinkWay*> used_{nullptr};
};

}  // namespace tactus
