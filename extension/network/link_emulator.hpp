// A network that is not there: delays, loses, doubles and disorders what comes in through another link.
//
// It sits at the receiving end and works on times of arrival, so that a delay is exact to the nanosecond
// whatever the tick, and is the same over a socket as inside one process in virtual time. What happens to a
// datagram depends on the seed and on how many came before it, on nothing else; two runs that differ in one
// condition meet the same luck in all the others.
//
// Threads: send(), receive() and counts() belong to the haptic thread, change() to the owner. All memory is
// taken in the constructor.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ports/link.hpp"
#include "network/datagram_store.hpp"
#include "network/link_conditions.hpp"
#include "network/memory_link.hpp"
#include "realtime/triple_buffer.hpp"

namespace tactus {

struct EmulatorCounts {
    std::uint64_t arrived = 0;     // from the link below
    std::uint64_t delivered = 0;   // to the caller
    std::uint64_t lost = 0;        // by independent or burst loss, or as the trace says
    std::uint64_t squeezed = 0;    // lost to the rate limit
    std::uint64_t duplicated = 0;  // copies made
    std::uint64_t held_back = 0;   // to be overtaken
    std::uint64_t no_room = 0;     // lost because more were under way than the emulator holds
};

class LinkEmulator final : public Link {
public:
    // `inner` must outlive the emulator. `seed`: see luck_of(). `capacity`: datagrams under way at once; two
    // thousand a second, delayed by ten seconds and up to ten more of jitter, are forty thousand.
    LinkEmulator(Link& inner, const LinkConditions& conditions, std::uint64_t seed,
                 std::size_t capacity = 65'536);

    // From the next receive() on; what is under way already keeps its fate.
    void change(const LinkConditions& conditions) { changed_.publish(conditions); }

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
        return inner_.send(datagram, now);
    }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override;
    std::size_t overhead() const override { return inner_.overhead(); }

    const EmulatorCounts& counts() const { return counts_; }

private:
    struct UnderWay {
        Nanoseconds due = 0;
        std::uint64_t number = 0;  // earlier ones first where two are due at once
        std::uint32_t place = 0;   // in store_
        std::uint32_t bytes = 0;
    };
    struct Luck;

    static bool later(const UnderWay& a, const UnderWay& b) {
        return a.due != b.due ? a.due > b.due : a.number > b.number;
    }

    void admit(Nanoseconds now);
    void decide(std::span<const std::byte> datagram, Nanoseconds arrived);
    bool is_lost(const Luck& luck);
    bool pass_narrow_place(std::size_t bytes, Nanoseconds& time);
    std::optional<Nanoseconds> recorded_delay() const;
    Nanoseconds delayed_by(double share) const;
    void schedule(std::span<const std::byte> datagram, Nanoseconds leaves, Nanoseconds delay, bool held_back);

    Link& inner_;
    LinkConditions conditions_;
    TripleBuffer<LinkConditions> changed_;
    std::uint64_t seed_;
    EmulatorCounts counts_;

    std::size_t capacity_;
    DatagramStore store_;
    std::array<std::byte, max_datagram_bytes> incoming_;
    std::vector<UnderWay> under_way_;  // a heap: the next one due first

    std::uint64_t scheduled_ = 0;
    bool bad_ = false;            // the burst model's state
    Nanoseconds line_free_ = 0;   // when the narrow place has sent what it has
    Nanoseconds newest_due_ = 0;  // of those that keep their order
};

}  // namespace tactus
