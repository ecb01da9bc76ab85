// One side of the conversation: wraps messages into packets, unwraps what comes, says hello, compares clocks,
// notices a far side that restarts, leaves or vanishes, and counts.
//
// Plain values, no thread and no clock of its own: belongs to whoever ticks, and is the same in real and in
// virtual time. All memory is taken in the constructor.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/ports/link.hpp"
#include "network/clock_sync.hpp"
#include "network/link_conditions.hpp"
#include "network/messages.hpp"
#include "network/queue_watch.hpp"
#include "network/sequence_window.hpp"

namespace tactus {

enum class PeerState : std::uint8_t {
    silent,      // nothing has been heard yet
    one_way,     // heard, but it does not hear this side yet
    connected,   // both hear each other
    wrong_side,  // it plays the same side as this one
    vanished,    // nothing has been heard for `vanish_after`
    left,        // it has said bye
};

struct EndpointSettings {
    Side side = Side::operator_side;
    std::uint8_t scenario = 4;
    std::uint64_t epoch = 1;  // another one at each start: see random_epoch(); never 0
    Nanoseconds period = 1'000'000;
    Nanoseconds hello_every = 100'000'000;
    Nanoseconds clock_every = 100'000'000;     // while it is heard; see ask_often()
    Nanoseconds vanish_after = 1'000'000'000;  // > hello_every
    ClockSkew skew;  // of this side's clock, as an experiment; none: an honest clock
};

struct TrafficRate {
    double packets = 0.0;     // (unit: 1/seconds)
    double bytes = 0.0;       // of packets (unit: bytes/second)
    double bits_per_s = 0.0;  // with all that the way adds to them, IP and UDP included
};

struct LinkStatistics {
    PeerState peer = PeerState::silent;
    std::uint64_t peer_epoch = 0;         // 0: none
    Hello peer_hello;                     // the newest one of that epoch
    std::uint64_t peer_hello_packet = 0;  // the sequence of its packet; 0: none
    std::uint64_t peer_restarts = 0;      // times that another epoch has followed one
    std::uint64_t vanishings = 0;

    std::uint64_t packets_sent = 0;
    std::uint64_t bytes_sent = 0;
    std::uint64_t not_sent = 0;          // the link had no room, or the message broke a range
    std::uint64_t packets_received = 0;  // believed, without copies
    std::uint64_t bytes_received = 0;
    std::uint64_t missing = 0;  // numbers of this epoch of the far side that have not come: lost or late
    std::uint64_t late = 0;     // overtaken by another one
    std::uint64_t copies = 0;   // arrived again, dropped
    std::uint64_t too_old = 0;  // so late that nobody can tell whether it is a copy, dropped
    std::uint64_t strange_epoch = 0;  // from before the far side's start, or before its hello, dropped
    std::uint64_t implausible = 0;    // of a sequence or a side that cannot be the far side's, dropped
    RefusalCounts refused;
    TrafficRate sent_rate;  // over the last whole second
    TrafficRate received_rate;

    ClockFigures clock;
    QueueFigures queue_there;     // on the way to the far side
    double lost_there = 0.0;      // share of what was sent that the far side misses, of late, 0 … 1
    double loss_unknown = 1.0;    // how much of that figure rests on no report yet, but on 0: 1 … 0
    double one_way_delay = 0.0;   // of packets that came, smoothed; 0 without a clock (unit: nanoseconds)
    double one_way_jitter = 0.0;  // mean change of it from packet to packet (unit: nanoseconds)
};

class Endpoint {
public:
    // At most so many datagrams are taken in one tick; the rest waits.
    static constexpr int max_datagrams_per_tick = 128;
    // Between two requests for the time, where it is asked for often.
    static constexpr Nanoseconds often_every = 20'000'000;

    // `link` must outlive the endpoint.
    Endpoint(Link& link, const EndpointSettings& settings);

    // --- one tick, in this order; `now` is the session's time

    void begin_tick(Nanoseconds now);

    // The next message of the far side that concerns the model: never Hello, Bye or a clock's. Null when
    // there is none. Valid until the next call.
    struct Received {
        Packet packet;
        Nanoseconds arrived = 0;  // on this side's clock (see local_time)
    };
    const Received* receive();

    // False where it could not be sent; counted.
    bool send(const Message& message);

    // Says hello and asks for the time, when due.
    void end_tick();

    // ---

    // The time is asked for every `often_every` for a while, as in the first second: so that a queue on the
    // way is known in time.
    void ask_often() { often_until_ = std::max(often_until_, now_ + often_for); }

    // Says bye, thrice since it is not repeated.
    void leave();

    // What this side's clock shows at `now` of the session: the time that belongs into messages.
    Nanoseconds local_time(Nanoseconds now) const { return settings_.skew.shown_at(now); }

    // In the last end_tick().
    bool has_said_hello() const { return has_said_hello_; }

    void set_scenario(std::uint8_t scenario) { settings_.scenario = scenario; }
    void set_skew(const ClockSkew& skew) { settings_.skew = skew; }
    void set_world(std::uint32_t object_count, const Vec3& gravity);

    bool connected() const { return statistics_.peer == PeerState::connected; }
    bool hears_peer() const { return statistics_.peer == PeerState::one_way || connected(); }
    std::uint64_t epoch() const { return settings_.epoch; }
    std::uint64_t peer_epoch() const { return statistics_.peer_epoch; }
    const ClockSync& clock() const { return clock_; }
    std::size_t overhead() const { return link_.overhead(); }  // of a packet (unit: bytes)
    const LinkStatistics& statistics() const { return statistics_; }

private:
    static constexpr Nanoseconds often_for = 300'000'000;

    // True where the packet is the caller's business.
    bool take(Nanoseconds arrived);
    bool admit(const PacketHeader& header);
    bool admit_epoch(const PacketHeader& header);
    bool is_plausible(const PacketHeader& header) const;
    void end_epoch_before();
    void note_report(const Hello& hello);
    void take_hello(const PacketHeader& header, const Hello& hello);
    void answer(const ClockRequest& request, Nanoseconds arrived);
    void take_answer(const ClockAnswer& answer, Nanoseconds arrived);
    void meet(std::uint64_t epoch);
    bool was_before(std::uint64_t epoch) const;
    void note_one_way(Nanoseconds sent_at, Nanoseconds arrived);
    void say_hello();
    void measure_rates(Nanoseconds now);

    Link& link_;
    EndpointSettings settings_;
    LinkStatistics statistics_;
    ClockSync clock_;
    QueueWatch queue_there_;
    double lost_there_ = 0.0;  // smoothed; below 0 while what was overtaken comes
    SequenceWindow window_;
    Hello own_hello_;
    std::uint64_t hello_sequence_ = 0;                            // of that
    std::uint64_t bye_sequence_ = 0;                              // 0: none
    std::uint64_t reported_packets_ = 0, reported_sequence_ = 0;  // by its last hello
    Received received_;
    std::array<std::byte, max_datagram_bytes> buffer_;

    // Epochs that are over: a packet of theirs that was held up somewhere brings none of them back.
    static constexpr std::size_t max_past = 32;
    struct PastEpoch {
        std::uint64_t epoch = 0;
        Nanoseconds over_at = 0;
    };
    std::array<PastEpoch, max_past> past_{};
    std::size_t past_count_ = 0;
    std::uint64_t epoch_before_ = 0;  // the one before the present one, which has not proved itself; 0: none

    Nanoseconds now_ = 0;        // of the tick
    Nanoseconds local_now_ = 0;  // on this side's clock
    int taken_this_tick_ = 0;
    std::uint64_t sequence_ = 0;
    Nanoseconds heard_at_ = 0;
    Nanoseconds left_at_ = 0;
    Nanoseconds admitted_at_ = 0;
    Nanoseconds newest_at_ = 0;    // when the highest sequence came
    Nanoseconds often_until_ = 0;  // the time is asked for often
    Nanoseconds next_hello_ = 0;
    Nanoseconds next_request_ = 0;
    std::uint32_t request_ = 0;
    Nanoseconds last_one_way_ = 0;
    bool one_way_known_ = false;
    bool ticked_ = false;
    bool leaves_ = false;
    bool has_said_hello_ = false;

    Nanoseconds rates_since_ = 0;
    std::uint64_t rate_base_[4] = {};  // packets and bytes sent, received
};

// From the system's source of chance. Off the loop.
std::uint64_t random_epoch();

}  // namespace tactus
