// What the far side's clock shows: offset, drift, and how sure that is, from exchanges of four timestamps.
//
// The one asking notes t0, the other notes t1 when the request comes and t2 when its answer goes, and the
// answer comes back at t3. With the same delay both ways the far clock is ahead by
//     ((t1 - t0) + (t2 - t3)) / 2,     with a delay there and back of (t3 - t0) - (t2 - t1);
// whatever the delays were, the error is at most half of that (Mills, RFC 5905). So the exchanges with the
// least delay are the ones to believe: the best one of each stretch of time is kept, and a line through those
// gives offset and drift. Each kept exchange bounds the true offset as well; the bounds widen by what two
// clocks may drift apart since, and the farther one from the line is its uncertainty.
//
// Plain arithmetic: reads no clock, allocates nothing, belongs to one thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/math/types.hpp"

namespace tactus {

struct ClockExchange {
    Nanoseconds t0 = 0, t3 = 0;  // on this side's clock
    Nanoseconds t1 = 0, t2 = 0;  // on the far side's

    Nanoseconds offset() const { return ((t1 - t0) + (t2 - t3)) / 2; }
    Nanoseconds delay() const { return (t3 - t0) - (t2 - t1); }
};

struct ClockFigures {
    bool known = false;            // false before the first exchange: all else is 0
    Nanoseconds offset = 0;        // far clock minus this one, when the figures are asked for
    double drift = 0.0;            // seconds that the far clock gains a second
    Nanoseconds uncertainty = 0;   // most that the offset may be wrong by, however uneven the delays are
    Nanoseconds least_delay = 0;   // there and back, of late
    Nanoseconds latest_delay = 0;  // there and back
    double mean_delay = 0.0;       // smoothed over about 16 exchanges (unit: nanoseconds)
    double jitter = 0.0;  // mean change of the delay from exchange to exchange, smoothed (unit: nanoseconds)
    std::uint64_t exchanges = 0;  // believed
    std::uint64_t refused =
        0;  // that no two clocks can have made: a negative delay, an answer before its request
    std::uint64_t jumps = 0;  // times that one of the clocks was set: all before was forgotten
};

class ClockSync {
public:
    // `stretch`: of which one exchange is kept (unit: nanoseconds), > 0. Sixteen of them are looked at.
    explicit ClockSync(Nanoseconds stretch = nanoseconds_per_second) : stretch_(stretch) {}

    // False where it is refused.
    bool add(const ClockExchange& exchange);

    // The far side has another clock now.
    void forget();

    // As of the last exchange, and as of `here` on this side's clock, not before it.
    const ClockFigures& figures() const { return figures_; }
    ClockFigures figures_at(Nanoseconds here) const;

    // What the far clock shows when this one shows `here`, and the other way round. 0 offset before the first
    // exchange.
    Nanoseconds far_time(Nanoseconds here) const { return here + offset_at(here); }
    Nanoseconds near_time(Nanoseconds far) const;

private:
    struct Kept {
        Nanoseconds here = 0;  // middle of the exchange
        Nanoseconds offset = 0;
        Nanoseconds delay = 0;
    };

    static constexpr std::size_t max_kept = 16;

    Nanoseconds offset_at(Nanoseconds here) const;
    bool contradicts(const Kept& sample) const;
    void start_anew();
    void keep(const Kept& sample);
    const Kept& best() const;
    void note_bounds(const Kept& newest);
    void fit_line();
    void note_delay(Nanoseconds delay);

    Nanoseconds stretch_;
    std::array<Kept, max_kept> kept_{};  // a ring: the best of each stretch
    std::size_t count_ = 0;
    std::size_t newest_ = 0;
    Nanoseconds stretch_began_ = 0;
    Kept anchor_;  // a point of the line
    double drift_ = 0.0;
    Nanoseconds last_ = 0;              // middle of the last exchange
    Nanoseconds least_ = 0, most_ = 0;  // that the offset can have been then
    ClockFigures figures_;
};

}  // namespace tactus
